#include "common/mesh/listing.hpp"

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "common/mesh/lister.hpp"

namespace palpate {
namespace {

std::string read_file(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) throw std::runtime_error("the file does not exist");
  if (!std::filesystem::is_regular_file(file)) throw std::runtime_error("this is not a file");
  std::ifstream in(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  if (!in) throw std::runtime_error("the file cannot be read");
  return bytes;
}

}  // namespace

FileListing list_mesh_file(const std::filesystem::path& file) try {
  const std::string bytes = read_file(file);
  FileCursor cursor(bytes);
  Lister lister;
  bytes.starts_with("# vtk DataFile") ? list_vtk(cursor, lister) : list_gmsh(cursor, lister);
  lister.faults.raise(file.string());
  return std::move(lister.listing);
} catch (const std::runtime_error& error) {
  const std::string where = file.string() + ": ", what = error.what();
  throw std::runtime_error(what.starts_with(where) ? what : where + what);
}

}  // namespace palpate

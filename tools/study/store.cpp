#include "tools/study/store.hpp"

#include <fmt/format.h>

#include <cctype>
#include <fstream>
#include <stdexcept>

#include "common/describe/digest.hpp"
#include "common/models/content_hash.hpp"
#include "tools/study/kinds.hpp"

namespace palpate::study {
namespace {

std::string first_line(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

}  // namespace

Store::Store(const std::filesystem::path& folder, const std::string& key) : folder_(folder / "points") {
  if (first_line(folder_ / "key") == key) return;
  if (std::filesystem::exists(folder_) && !std::filesystem::exists(folder_ / "key"))
    throw std::runtime_error(
        fmt::format("{}: not made by a study, so it stays; name another folder", folder_.string()));
  new_ = true;
  std::filesystem::remove_all(folder_);
  std::filesystem::create_directories(folder_);
  std::ofstream out(folder_ / "key");
  out << key << '\n';
  if (!out.flush()) throw std::runtime_error(fmt::format("{}: cannot be written", folder_.string()));
}

std::filesystem::path Store::file(const Point& point) const {
  std::string name = fmt::format("{} {} {}", point.method, point.knob, point.value);
  const std::string hash = digest(name).substr(0, 8);
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return folder_ / fmt::format("{}-{}.csv", name.substr(0, 80), hash);
}

std::optional<Result> Store::find(const Point& point) const {
  if (!std::filesystem::exists(file(point))) return {};
  try {
    return read_fragment(file(point));
  } catch (const std::runtime_error&) {
    return {};
  }
}

void Store::keep(const Point& point, const Result& result) const {
  write_fragment(result, file(point));
}

std::string study_key(const Scene& scene, bool quick) {
  constexpr int definitions = 5;  // changes with every change of what the figures mean
  std::string key =
      fmt::format("{} {} {} {}", PALPATE_VERSION, definitions, quick ? "quick" : "whole", scene_hash(scene));
  for (const Body& body : scene.bodies)
    key += " " + content_hash(body) + std::visit([](const auto& spec) { return key_of(spec); }, body);
  return key;
}

}  // namespace palpate::study

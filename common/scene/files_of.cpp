#include <algorithm>

#include "common/describe/toml_writer.hpp"
#include "common/scene/moved_files.hpp"

namespace palpate {
namespace {

class FileList : public TomlWriter {
 public:
  void file(const Key&, std::filesystem::path& value) override {
    if (!value.empty() && std::ranges::find(files, value) == files.end()) files.push_back(value);
  }
  std::vector<std::filesystem::path> files;
};

}  // namespace

std::vector<std::filesystem::path> files_of(const Scene& scene) {
  Scene copy = scene;
  FileList list;
  describe(list, copy);
  return list.files;
}

}  // namespace palpate

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

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

void keep_files_of(const Scene& scene, std::initializer_list<std::filesystem::path> outputs) {
  std::vector<std::filesystem::path> inputs = files_of(scene);
  inputs.push_back(scene.file);
  for (const std::filesystem::path& output : outputs)
    for (const std::filesystem::path& input : inputs) {
      std::error_code missing;
      if (!output.empty() && std::filesystem::equivalent(output, input, missing))
        throw std::runtime_error(fmt::format("{}: {} needs this file, and would lose it: give another name",
                                             output.string(), scene.file.string()));
    }
}

}  // namespace palpate

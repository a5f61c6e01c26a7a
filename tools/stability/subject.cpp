#include "tools/stability/subject.hpp"

#include <fmt/format.h>

#include "common/describe/digest.hpp"
#include "common/describe/toml_writer.hpp"
#include "common/models/content_hash.hpp"

namespace palpate::stability {
namespace {

/// All keys of a device; files by what is in them.
class DeviceText : public TomlWriter {
 public:
  void file(const Key& key, std::filesystem::path& value) override {
    if (!value.empty()) line(key, file_digest(value));
  }
};

std::string text_of(DeviceSpec device) {
  DeviceText text;
  std::visit([&](auto& spec) { describe(text, spec); }, device);
  return std::string(kind_of(device)) + text.text();
}

std::string digest_of(const Scene& scene) {
  std::string all = scene_hash(scene);
  for (const Body& body : scene.bodies) all += content_hash(body);
  for (const Tool& tool : scene.tools) all += text_of(tool.device);
  return digest(all);
}

}  // namespace

std::string subject_of(const Scene* scene, bool quick) {
  return fmt::format("{}{} by program {} {}", scene ? "scene " + digest_of(*scene) : "the general cases",
                     quick ? ", quick," : "", PALPATE_VERSION, file_digest("/proc/self/exe"));
}

}  // namespace palpate::stability

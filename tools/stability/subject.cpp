#include "tools/stability/subject.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "common/describe/digest.hpp"
#include "common/models/content_hash.hpp"

namespace palpate::stability {
namespace {

std::string digest_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  return digest(bytes);
}

// What runs with a device depend on: its kind, and the file that moves it if there is one.
std::string text_of(const DeviceSpec& device) {
  const std::filesystem::path file = motion_file_of(device);
  return std::string(kind_of(device)) + (file.empty() ? "" : digest_of(file));
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
                     quick ? ", quick," : "", PALPATE_VERSION, digest_of("/proc/self/exe"));
}

}  // namespace palpate::stability

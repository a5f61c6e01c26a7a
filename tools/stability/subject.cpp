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

std::string text_of(const BusDeviceSpec& device) {
  return std::string(device.kKind);
}
template <class Recorded>
std::string text_of(const Recorded& device) {
  return std::string(device.kKind) + (device.trajectory.empty() ? "" : digest_of(device.trajectory));
}

std::string digest_of(const Scene& scene) {
  std::string all = scene_hash(scene);
  for (const Body& body : scene.bodies) all += content_hash(body);
  for (const Tool& tool : scene.tools)
    all += std::visit([](const auto& device) { return text_of(device); }, tool.device);
  return digest(all);
}

}  // namespace

std::string subject_of(const Scene* scene, bool quick) {
  return fmt::format("{}{} by program {} {}", scene ? "scene " + digest_of(*scene) : "the general cases",
                     quick ? ", quick," : "", PALPATE_VERSION, digest_of("/proc/self/exe"));
}

}  // namespace palpate::stability

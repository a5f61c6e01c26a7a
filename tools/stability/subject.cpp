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
template <class Spec>
std::string text_of(const Spec& device) {
  std::string text(device.kKind);
  if constexpr (requires { device.trajectory; })
    if (!device.trajectory.empty()) text += digest_of(device.trajectory);
  return text;
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

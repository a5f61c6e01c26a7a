#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "common/scene/scene.hpp"

namespace palpate {

namespace {

std::string digest(const std::string& text) {
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string file_digest(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error(file.string() + ": the file cannot be read");
  std::ostringstream text;
  text << stream.rdbuf();
  return digest(text.str());
}

}  // namespace

std::string scene_hash(const Scene& scene) {
  Scene agreed;
  agreed.bodies = scene.bodies;
  agreed.tools = scene.tools;
  agreed.contact = scene.contact;
  agreed.passivity = scene.passivity;
  agreed.rates = scene.rates;
  // Where files lie and what moves a tool is each machine's own affair. Meshes go into the archive's hash.
  for (Body& body : agreed.bodies) {
    body.mesh.clear();
    if (body.hybrid && !body.hybrid->mesh.empty()) body.hybrid->mesh = "coarse";
    if (!body.nonlinear) continue;
    for (std::filesystem::path* curve : {&body.nonlinear->force_curve, &body.nonlinear->radial_curve})
      *curve = file_digest(*curve);
    if (!body.nonlinear->specimen_mesh.empty()) body.nonlinear->specimen_mesh = "specimen";
  }
  for (Tool& tool : agreed.tools) {
    tool.device.clear();
    tool.trajectory.clear();
  }
  return digest(to_toml(agreed));
}

}  // namespace palpate

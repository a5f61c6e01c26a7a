#include "common/tensors/find_archive.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "common/mesh/tube.hpp"
#include "common/tensors/content_hash.hpp"

namespace palpate {
namespace {

/// A catheter has no tensors: its archive is the tube about its particles at rest.
Archive tube_at_rest(const Body& body) {
  const Catheter& catheter = *body.catheter;
  const TubeSurface tube(catheter.particles, catheter.radius);
  std::vector<Eigen::Vector3d> particles;
  for (int i = 0; i < catheter.particles; ++i)
    particles.push_back(catheter.tail + i / (catheter.particles - 1.0) * (catheter.tip - catheter.tail));
  std::vector<Eigen::Vector3f> position(tube.vertices()), normal(tube.vertices());
  tube.place(particles, position, normal);

  Archive archive;
  archive.body = body.name;
  archive.model = body.model;
  archive.content_hash = content_hash(body);
  archive.mesh_nodes = tube.vertices();
  archive.young = {body.material.young};
  archive.poisson = {body.material.poisson};
  archive.density = {body.material.density};
  archive.surface.triangles = tube.triangles();
  for (int i = 0; i < tube.vertices(); ++i) {
    archive.surface.position.push_back(position[i].cast<double>());
    archive.surface.node_number.push_back(i);
    archive.surface.fixed.push_back({false, false, false});
  }
  return archive;
}

}  // namespace

std::filesystem::path archive_path(const Scene&, const Body& body) {
  if (body.model == "catheter") return {};
  return archive_path(body.mesh, body.name, content_hash(body));
}

Archive find_archive(const Scene& scene, const Body& body, ArchivePart part) {
  if (body.catheter) return tube_at_rest(body);
  const std::string hash = content_hash(body);
  const auto file = archive_path(body.mesh, body.name, hash);
  const auto advice = fmt::format("run `palpate precompute {}` first", scene.file.string());
  if (!std::filesystem::exists(file))
    throw std::runtime_error(fmt::format("body '{}' has no archive of tensors yet: {}", body.name, advice));
  try {
    return read_archive(file, part, hash);
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}; {}", error.what(), advice));
  }
}

}  // namespace palpate

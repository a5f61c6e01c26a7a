#include "common/archive/archive.hpp"
#include "common/mesh/tube.hpp"
#include "common/models/catheter/spec.hpp"

namespace palpate {

std::optional<Archive> made_archive(const CatheterSpec& body) {
  const Catheter& catheter = body.catheter;
  const TubeSurface tube(catheter.particles, catheter.radius);
  std::vector<Eigen::Vector3d> particles;
  for (int i = 0; i < catheter.particles; ++i)
    particles.push_back(catheter.tail + i / (catheter.particles - 1.0) * (catheter.tip - catheter.tail));
  std::vector<Eigen::Vector3f> position(tube.vertices()), normal(tube.vertices());
  tube.place(particles, position, normal);

  Archive archive;
  archive.body = body.name;
  archive.model = CatheterSpec::kKind;
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

ArchiveJob archive_job(const CatheterSpec&, const Progress&) {
  return {};
}

}  // namespace palpate

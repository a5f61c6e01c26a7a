#include "common/fem/specimen.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "common/fem/direct.hpp"
#include "common/fem/fine_problem.hpp"
#include "common/fem/fine_space.hpp"
#include "common/fem/selection.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

struct Extent {
  Eigen::Vector3d min, max;
  double tolerance() const { return 1e-6 * (max - min).norm(); }
};

Extent extent_of(const TetMesh& mesh, const std::vector<int>& nodes) {
  Extent extent{mesh.nodes[nodes.at(0)], mesh.nodes[nodes.at(0)]};
  for (int node : nodes) {
    extent.min = extent.min.cwiseMin(mesh.nodes[node]);
    extent.max = extent.max.cwiseMax(mesh.nodes[node]);
  }
  return extent;
}

double mean_outward(const TetMesh& mesh, const std::vector<int>& surface, const Extent& extent,
                    const std::vector<Eigen::Vector3d>& displacement) {
  const Eigen::Vector3d middle = 0.5 * (extent.min + extent.max);
  double nearest = std::numeric_limits<double>::infinity();
  for (int node : surface) nearest = std::min(nearest, std::abs(mesh.nodes[node].z() - middle.z()));
  const double band = nearest + 0.02 * (extent.max.z() - extent.min.z());
  double sum = 0;
  int count = 0;
  for (int node : surface) {
    if (std::abs(mesh.nodes[node].z() - middle.z()) > band) continue;
    const Eigen::Vector2d arm = (mesh.nodes[node] - middle).head<2>();
    sum += arm.normalized().dot(displacement[node].head<2>());
    ++count;
  }
  return sum / count;
}

}  // namespace

SpecimenSlopes press_specimen(const TetMesh& mesh, const Material& material, const std::optional<Offline>& offline) {
  const auto surface = extract_surface(mesh).nodes;
  const Extent extent = extent_of(mesh, surface);
  MaterialField materials;
  materials.materials.push_back(material);
  StaticProblem problem{mesh, std::move(materials), DofMap(mesh)};
  std::vector<int> top;
  for (int node : surface) {
    const bool low = mesh.nodes[node].z() < extent.min.z() + extent.tolerance();
    const bool high = mesh.nodes[node].z() > extent.max.z() - extent.tolerance();
    if (high) top.push_back(node);
    for (int axis = 0; axis < 3; ++axis)
      if (low) problem.dofs.fix(node, axis);
  }
  problem.dofs.number();
  if (const int motions = remaining_rigid_motions(mesh, problem.dofs))
    throw std::runtime_error("the specimen mesh has no flat lower end to stand on: " + std::to_string(motions) +
                             " rigid-body motions remain");

  const double press = 1e-3 * (extent.max.z() - extent.min.z());
  std::vector<Constraint> plate;
  for (int node : top)
    for (int axis = 0; axis < 3; ++axis) plate.push_back(hold(node, axis, axis == 2 ? -press : 0.0));
  const auto solution =
      is_finer(offline)
          ? solve_direct(make_fine_problem(mesh, *offline, problem.materials, problem.dofs, "specimen"), plate)
          : solve_direct(problem, plate);
  double force = 0;
  for (int node : top) force -= solution.force[node].z();
  return {force / press, mean_outward(mesh, surface, extent, solution.displacement) / press};
}

}  // namespace palpate

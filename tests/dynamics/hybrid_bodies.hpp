#pragma once
#include <cmath>
#include <memory>
#include <random>

#include "common/dynamics/condensed_part.hpp"
#include "common/dynamics/tensor_mass.hpp"
#include "common/fem/direct.hpp"
#include "common/models/hybrid/precompute.hpp"
#include "tests/fem/meshes_for_tests.hpp"

namespace palpate::testing {

/// A jittered block of two materials on its bottom; edges of about `cell`.
inline TetMesh make_hybrid_block(const std::array<int, 3>& cells, double cell, unsigned seed = 3) {
  return make_jittered_block({cell * cells[0], cell * cells[1], cell * cells[2]}, cells, 0.15, seed);
}

/// Tetrahedra on one side of a random plane or in a random sphere, by their centroids: between a fifth and
/// four fifths.
inline std::vector<int> random_part(const TetMesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Eigen::Vector3d size = mesh.nodes.back();
  for (;;) {
    const Eigen::Vector3d normal = Eigen::Vector3d(uniform(random), uniform(random), uniform(random)).normalized();
    const Eigen::Vector3d centre =
        0.5 * size + 0.4 * size.cwiseProduct(Eigen::Vector3d(uniform(random), uniform(random), uniform(random)));
    const double radius = size.norm() * (0.25 + 0.1 * uniform(random));
    const bool sphere = seed % 2 == 0;
    std::vector<int> part;
    for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
      Eigen::Vector3d at = -centre;
      for (int node : mesh.tetrahedra[e]) at += mesh.nodes[node] / 4;
      if (sphere ? at.norm() < radius : at.dot(normal) > 0) part.push_back(e);
    }
    const double share = static_cast<double>(part.size()) / static_cast<double>(mesh.tetrahedra.size());
    if (share > 0.2 && share < 0.8) return part;
  }
}

inline HybridSpec hybrid_body(std::vector<int> part, const Eigen::Vector3d& gravity = Eigen::Vector3d::Zero()) {
  HybridSpec body;
  static_cast<SolidSpec&>(body) = make_body(5e3, 0.4);
  MaterialRegion stiff;
  stiff.where.box = Box{{-1, -1, -1}, {0.025, 1, 1}};
  stiff.material = {9e3, 0.3, 1400};
  body.materials = {stiff};
  body.dynamic.gravity = gravity;
  body.hybrid.regions.emplace_back();
  body.hybrid.regions[0].indices = std::move(part);
  return body;
}

/// A hybrid body in motion.
template <class Scalar>
struct HybridRun {
  HybridRun(const Archive& made, double friction, double damping, const Eigen::Vector3d& gravity)
      : archive(made),
        model(elastic_mesh(archive), Integrator::rk4, damping),
        part(archive, friction, std::is_same_v<Scalar, float>) {
    part.couple(model);
    model.set_gravity(gravity);
    part.hold();
    part.add_loads(model);
  }
  double step_size() const { return 0.9 * max_step(Integrator::rk4, model.frequency_bound(), 0); }
  void run(double time) {
    const double dt = step_size();
    for (int i = 0; i < time / dt; ++i) model.step(dt);
    part.take(model);
  }
  /// Of any node of the archive.
  Eigen::Vector3d displacement(int node) const {
    return part.owns(node) ? part.displacement(node) : model.displacement(node);
  }
  int node(int mesh_node) const {
    const auto& numbers = archive.surface.node_number;
    return static_cast<int>(std::find(numbers.begin(), numbers.end(), mesh_node) - numbers.begin());
  }

  Archive archive;
  TensorMass<Scalar> model;
  CondensedPart part;
};

/// Lumped weights [N] per mesh node.
inline std::vector<Eigen::Vector3d> weights(const StaticProblem& problem, const Eigen::Vector3d& gravity) {
  std::vector<Eigen::Vector3d> load(problem.mesh.nodes.size(), Eigen::Vector3d::Zero());
  for (std::size_t e = 0; e < problem.mesh.tetrahedra.size(); ++e) {
    const auto& t = problem.mesh.tetrahedra[e];
    const auto& x = problem.mesh.nodes;
    const double volume = tet_gradients({x[t[0]], x[t[1]], x[t[2]], x[t[3]]}).volume;
    for (int node : t) load[node] += problem.materials.at(static_cast<int>(e)).density * volume / 4 * gravity;
  }
  return load;
}

/// Largest difference between the archive's nodes and a static solution, relative to the largest
/// displacement.
template <class Run>
double static_difference(const Run& run, const StaticSolution& direct) {
  std::vector<Eigen::Vector3d> ours, theirs;
  for (int i = 0; i < run.archive.surface.size(); ++i) {
    ours.push_back(run.displacement(i));
    theirs.push_back(direct.displacement[run.archive.surface.node_number[i]]);
  }
  return relative_difference(ours, theirs);
}

}  // namespace palpate::testing

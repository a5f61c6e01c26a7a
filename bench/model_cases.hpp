#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "bench/soft_boxes.hpp"
#include "common/archive/compliance.hpp"
#include "common/dynamics/dynamic_model.hpp"
#include "common/fem/direct.hpp"
#include "common/mesh/surface.hpp"
#include "common/models/quasi_static/precompute.hpp"

/// The questions of RR3510's table 1, put to any model: fields and stiffnesses of one solid under one load.
namespace palpate::bench {

using Field = std::vector<Eigen::Vector3d>;

/// A body in the forms that the models and the direct solver take, with nodal loads [N].
struct LoadedSolid {
  QuasiStaticSpec body;
  StaticProblem problem;
  ElasticMesh mesh;
  Field load;
};

/// The same solid, 70 x 70 x 60 mm, cut into tetrahedra in different ways.
enum class Meshing { five, five_mirrored, five_regular, six };

inline void mirror_x(TetMesh& mesh, double length) {
  for (auto& x : mesh.nodes) x.x() = length - x.x();
  for (auto& t : mesh.tetrahedra) std::swap(t[2], t[3]);
  std::swap(mesh.groups["x0"], mesh.groups["x1"]);
}

/// Inner nodes move by up to a tenth of a cell, except in five_regular; the outer faces stay flat.
inline TetMesh make_solid_mesh(Meshing meshing) {
  const double cell = 0.01;
  const std::array<int, 3> cells{7, 7, 6};
  const Eigen::Vector3d extent(0.07, 0.07, 0.06);
  TetMesh mesh = meshing == Meshing::six ? make_block(Eigen::Vector3d::Zero(), extent, cells)
                                         : make_block_of_five(Eigen::Vector3d::Zero(), extent, cells);
  if (meshing == Meshing::five_mirrored) mirror_x(mesh, extent.x());
  if (meshing == Meshing::five_regular) return mesh;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-0.1 * cell, 0.1 * cell);
  for (auto& x : mesh.nodes)
    for (int axis = 0; axis < 3; ++axis) {
      const double shift = jitter(random);
      if (x[axis] > 1e-9 && x[axis] < extent[axis] - 1e-9) x[axis] += shift;
    }
  return mesh;
}

/// A traction [Pa] on the top face as nodal forces; small enough for every model to answer linearly.
inline Field top_load(const TetMesh& mesh, const Eigen::Vector3d& traction) {
  double top = 0;
  for (const auto& x : mesh.nodes) top = std::max(top, x.z());
  Field load(mesh.nodes.size(), Eigen::Vector3d::Zero());
  for (const auto& [a, b, c] : extract_surface(mesh).triangles) {
    if (std::min({mesh.nodes[a].z(), mesh.nodes[b].z(), mesh.nodes[c].z()}) < top - 1e-9) continue;
    const double area = 0.5 * (mesh.nodes[b] - mesh.nodes[a]).cross(mesh.nodes[c] - mesh.nodes[a]).norm();
    for (const int node : {a, b, c}) load[node] += area / 3 * traction;
  }
  return load;
}

/// The solid stands on its bottom and is pressed and pushed on its top.
inline LoadedSolid make_loaded_solid(TetMesh mesh, const Material& material) {
  QuasiStaticSpec body;
  body.name = "solid";
  body.material = material;
  body.fixed.emplace_back();
  body.fixed[0].where.group = "bottom";
  StaticProblem problem = make_static_problem(body, mesh);
  ElasticMesh elastic{mesh.nodes, mesh.tetrahedra, {}, {material}, {}};
  for (int n = 0; n < elastic.nodes(); ++n)
    elastic.fixed.push_back({mesh.nodes[n].z() == 0, mesh.nodes[n].z() == 0, mesh.nodes[n].z() == 0});
  Field load = top_load(mesh, 1e-4 * material.young * Eigen::Vector3d(0.2, 0, -1));
  return {std::move(body), std::move(problem), std::move(elastic), std::move(load)};
}

inline LoadedSolid make_loaded_solid(Meshing meshing, const Material& material) {
  return make_loaded_solid(make_solid_mesh(meshing), material);
}

/// A slot from the side x = 0 into the solid, one layer of cells high, below the loaded face.
inline std::vector<int> slot(const TetMesh& mesh) {
  std::vector<int> tetrahedra;
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const int node : mesh.tetrahedra[t]) middle += mesh.nodes[node] / 4;
    if (middle.x() < 0.04 && middle.z() > 0.02 && middle.z() < 0.03) tetrahedra.push_back(t);
  }
  return tetrahedra;
}

inline TetMesh without(TetMesh mesh, const std::vector<int>& removed) {
  std::vector<char> gone(mesh.tetrahedra.size(), 0);
  for (const int t : removed) gone[t] = 1;
  std::vector<std::array<int, 4>> left;
  for (std::size_t t = 0; t < gone.size(); ++t)
    if (!gone[t]) left.push_back(mesh.tetrahedra[t]);
  mesh.tetrahedra = std::move(left);
  return mesh;
}

/// Where a dynamic model comes to rest under the load, after a cut if one is given.
template <class Model>
Field rest_field(const LoadedSolid& solid, std::span<const int> cut = {}, double tolerance = 1e-9) {
  const double damping = 80;  // near the critical one of the lowest mode
  Model model(solid.mesh, Integrator::rk4, damping);
  model.remove(cut);
  for (int n = 0; n < model.nodes(); ++n) model.set_load(n, solid.load[n]);
  const double dt = 0.95 * max_step(Integrator::rk4, model.frequency_bound(), damping);
  Field u(model.nodes());
  for (int round = 0; round < 400; ++round) {
    for (int i = 0; i < 100; ++i) model.step(dt);
    double size = 0, change = 0;
    for (int n = 0; n < model.nodes(); ++n) {
      const Eigen::Vector3d now = model.displacement(n);
      size = std::max(size, now.norm());
      change = std::max(change, (now - u[n]).norm());
      u[n] = now;
    }
    if (change < tolerance * size) break;
  }
  return u;
}

/// The pre-computed model's displacements, zero on nodes that its surface does not list.
inline Field superposed_field(const LoadedSolid& solid) {
  const Archive archive = precompute(solid.body, solid.problem.mesh);
  const Compliance<double> compliance(archive, Compliance<double>::Rows::surface);
  const auto& surface = archive.surface;
  Field u(solid.load.size(), Eigen::Vector3d::Zero());
  for (int k = 0; k < surface.touchable; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      const double force = solid.load[surface.node_number[k]][axis];
      if (force == 0) continue;
      const double* column = compliance.column(k, axis);
      for (int n = 0; n < surface.size(); ++n)
        u[surface.node_number[n]] += force * Eigen::Map<const Eigen::Vector3d>(column + 3 * n);
    }
  return u;
}

inline Field direct_field(const LoadedSolid& solid) {
  return solve_loads(solid.problem, solid.load).displacement;
}

/// Largest difference over the largest displacement, over the nodes of the solid's surface.
inline double field_error(const LoadedSolid& solid, const Field& field, const Field& reference) {
  double difference = 0, size = 0;
  for (const int n : extract_surface(solid.problem.mesh).nodes) {
    difference = std::max(difference, (field[n] - reference[n]).norm());
    size = std::max(size, reference[n].norm());
  }
  return difference / size;
}

/// How far a load moves the places it acts on, weighted by itself [J]: its inverse is the stiffness against
/// that load.
inline double give(const LoadedSolid& solid, const Field& field) {
  double sum = 0;
  for (std::size_t n = 0; n < field.size(); ++n) sum += solid.load[n].dot(field[n]);
  return sum;
}

/// Largest nodal force under a rotation of 30 degrees over the largest one under a stretch of 10 per cent.
/// `forces` gives the elastic forces of a field of displacements.
template <class Forces>
double false_force(const ElasticMesh& mesh, Forces&& forces) {
  const auto largest = [&](const Eigen::Matrix3d& a) {
    Field u;
    for (const auto& x : mesh.rest) u.push_back(a * x - x);
    double size = 0;
    for (const Eigen::Vector3d& f : forces(u)) size = std::max(size, f.norm());
    return size;
  };
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 3).normalized();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(std::numbers::pi / 6, axis).toRotationMatrix();
  Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
  stretch(0, 0) = 1.1;
  return largest(turn) / largest(stretch);
}

/// The same of a dynamic model; no node is fixed.
template <class Model>
double false_force_of(ElasticMesh mesh) {
  mesh.fixed.assign(mesh.rest.size(), {false, false, false});
  Model model(mesh, Integrator::rk4, 0);
  return false_force(mesh, [&](const Field& u) {
    Field force;
    for (int n = 0; n < model.nodes(); ++n) model.set_motion(n, u[n], Eigen::Vector3d::Zero());
    for (int n = 0; n < model.nodes(); ++n) force.push_back(model.elastic_force(n));
    return force;
  });
}

}  // namespace palpate::bench

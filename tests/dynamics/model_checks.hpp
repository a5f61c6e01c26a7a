#pragma once
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "common/dynamics/dynamic_model.hpp"
#include "tests/dynamics/dynamic_meshes.hpp"

namespace palpate::testing {

/// A jittered block of 1 cm cells with nothing fixed.
inline ElasticMesh free_block(const std::array<int, 3>& cells, const Material& material = {1e4, 0.4, 1000}) {
  const Eigen::Vector3d extent(0.01 * cells[0], 0.01 * cells[1], 0.01 * cells[2]);
  const TetMesh tets = make_jittered_block(extent, cells, 0.15);
  return {tets.nodes, tets.tetrahedra, {tets.nodes.size(), {false, false, false}}, {material}, {}};
}

inline void set_field(DynamicModel& model, const std::vector<Eigen::Vector3d>& u) {
  for (int n = 0; n < model.nodes(); ++n) model.set_motion(n, u[n], Eigen::Vector3d::Zero());
}

/// What the model remembers.
inline std::vector<std::uint8_t> saved(const DynamicModel& model) {
  std::vector<std::uint8_t> bytes(model.state_size());
  model.save(bytes.data());
  return bytes;
}

inline std::vector<Eigen::Vector3d> force_field(const DynamicModel& model) {
  std::vector<Eigen::Vector3d> force;
  for (int n = 0; n < model.nodes(); ++n) force.push_back(model.elastic_force(n));
  return force;
}

inline std::vector<Eigen::Vector3d> displacement_field(const DynamicModel& model) {
  std::vector<Eigen::Vector3d> u;
  for (int n = 0; n < model.nodes(); ++n) u.push_back(model.displacement(n));
  return u;
}

/// Displacements that carry the rest shape to a + A (x - centre) + centre.
inline std::vector<Eigen::Vector3d> affine_field(const ElasticMesh& mesh, const Eigen::Matrix3d& a,
                                                 const Eigen::Vector3d& shift = Eigen::Vector3d::Zero()) {
  const Eigen::Vector3d centre = mesh.rest[mesh.nodes() / 2];
  std::vector<Eigen::Vector3d> u;
  for (const auto& x : mesh.rest) u.push_back(a * (x - centre) + centre + shift - x);
  return u;
}

inline Eigen::Matrix3d rotation(double angle, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

inline double largest(const std::vector<Eigen::Vector3d>& field) {
  double size = 0;
  for (const auto& x : field) size = std::max(size, x.cwiseAbs().maxCoeff());
  return size;
}

/// Elastic forces are minus the derivative of the energy at the model's displacements.
inline void expect_forces_from_energy(DynamicModel& model, double step, double tolerance) {
  const auto u = displacement_field(model);
  const auto force = force_field(model);
  for (int n = 0; n < model.nodes(); n += 3)
    for (int axis = 0; axis < 3; ++axis) {
      double energy[2];
      for (const int side : {0, 1}) {
        const Eigen::Vector3d moved = u[n] + (side ? step : -step) * Eigen::Vector3d::Unit(axis);
        model.set_motion(n, moved, Eigen::Vector3d::Zero());
        energy[side] = model.energy();
      }
      model.set_motion(n, u[n], Eigen::Vector3d::Zero());
      EXPECT_NEAR(force[n][axis], (energy[0] - energy[1]) / (2 * step), tolerance * largest(force));
    }
}

/// Forces and moments of all forces sum to zero.
inline void expect_balance(const DynamicModel& model, const ElasticMesh& mesh, double tolerance) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  double size = 0;
  for (int n = 0; n < model.nodes(); ++n) {
    const Eigen::Vector3d f = model.elastic_force(n);
    force += f;
    moment += (mesh.rest[n] + model.displacement(n)).cross(f);
    size += f.norm();
  }
  const double reach = (mesh.rest.back() - mesh.rest.front()).norm();
  EXPECT_LT(force.norm(), tolerance * size);
  EXPECT_LT(moment.norm(), tolerance * size * reach);
}

/// Largest eigenvalue of M^-1 dF/du at the model's displacements, from below, by power iteration on
/// differences of forces.
inline double stiffest_mode(DynamicModel& model, int iterations = 200) {
  const auto u = displacement_field(model);
  const auto force = force_field(model);
  auto mode = random_field(u.size(), 1, 11);
  double value = 0;
  const double step = 1e-7;
  for (int i = 0; i < iterations; ++i) {
    for (std::size_t n = 0; n < u.size(); ++n) model.set_motion(n, u[n] + step * mode[n], Eigen::Vector3d::Zero());
    double product = 0, norm = 0, next = 0;
    std::vector<Eigen::Vector3d> image;
    for (std::size_t n = 0; n < u.size(); ++n) {
      const double mass = model.mass(n);
      image.push_back((force[n] - model.elastic_force(n)) / (step * mass));
      product += mass * mode[n].dot(image[n]);
      norm += mass * mode[n].squaredNorm();
      next += mass * image[n].squaredNorm();
    }
    value = product / norm;
    for (std::size_t n = 0; n < u.size(); ++n) mode[n] = image[n] * std::sqrt(norm / next);
  }
  set_field(model, u);
  return value;
}

inline ElasticMesh without(ElasticMesh mesh, const std::vector<int>& removed) {
  std::vector<char> gone(mesh.tetrahedra.size(), 0);
  for (const int t : removed) gone[t] = 1;
  ElasticMesh left = mesh;
  left.tetrahedra.clear();
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    if (!gone[t]) left.tetrahedra.push_back(mesh.tetrahedra[t]);
  return left;
}

inline std::vector<int> random_tetrahedra(const ElasticMesh& mesh, double share, unsigned seed) {
  std::mt19937 random(seed);
  std::bernoulli_distribution chosen(share);
  std::vector<int> tetrahedra;
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t)
    if (chosen(random)) tetrahedra.push_back(t);
  std::shuffle(tetrahedra.begin(), tetrahedra.end(), random);
  return tetrahedra;
}

/// Removal leaves the model of the remaining tetrahedra, to the last bit, in masses and in the motion that
/// follows.
template <class Model>
void expect_removal_as_built_afresh(const ElasticMesh& mesh, unsigned seed) {
  Model cut(mesh, Integrator::rk4, 3);
  const auto removed = random_tetrahedra(mesh, 0.3, seed);
  for (const int t : removed) cut.remove(std::span(&t, 1));
  Model fresh(without(mesh, removed), Integrator::rk4, 3);
  ASSERT_LE(cut.frequency_bound(), Model(mesh, Integrator::rk4, 3).frequency_bound());
  EXPECT_EQ(cut.frequency_bound(), fresh.frequency_bound());
  const auto start = random_field(mesh.rest.size(), 1e-3, seed);
  for (Model* model : {&cut, &fresh}) {
    model->set_gravity({0, 1, -9.81});
    set_field(*model, start);
  }
  const double dt = 0.5 / cut.frequency_bound();
  for (int i = 0; i < 100; ++i) cut.step(dt), fresh.step(dt);
  for (int n = 0; n < mesh.nodes(); ++n) ASSERT_EQ(cut.mass(n), fresh.mass(n));
  EXPECT_EQ(saved(cut), saved(fresh));
}

/// Steps under heavy damping until the body rests.
inline void settle(DynamicModel& model, double dt, int steps) {
  for (int i = 0; i < steps; ++i) model.step(dt);
}

}  // namespace palpate::testing

#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "common/dynamics/elastic_mesh.hpp"
#include "common/fem/elasticity.hpp"

namespace palpate::bench {

/// The textbook way, as a yardstick: force by a loop over the elements, each one's 12x12 stiffness times its
/// corners' displacements, and classical RK4 in four stages.
template <class Scalar>
class ElementLoop {
 public:
  ElementLoop(const ElasticMesh& mesh, double damping, const Eigen::Vector3d& gravity)
      : tetrahedra_(mesh.tetrahedra), damping_(static_cast<Scalar>(damping)) {
    const std::size_t n = 3 * mesh.rest.size();
    for (Vector* v : {&u_, &v_, &inverse_mass_, &load_, &force_, &stage_u_, &stage_v_, &rate_, &sum_u_, &sum_v_})
      v->setZero(static_cast<Eigen::Index>(n));
    std::vector<double> mass(mesh.rest.size(), 0);
    for (std::size_t t = 0; t < tetrahedra_.size(); ++t) {
      const auto& [a, b, c, d] = tetrahedra_[t];
      const auto tet = tet_gradients({mesh.rest[a], mesh.rest[b], mesh.rest[c], mesh.rest[d]});
      const Material& material = mesh.material(static_cast<int>(t));
      stiffness_.push_back(element_stiffness(tet, lame(material)).template cast<Scalar>());
      for (int node : tetrahedra_[t]) mass[node] += material.density * tet.volume / 4;
    }
    for (int node = 0; node < mesh.nodes(); ++node)
      for (int axis = 0; axis < 3; ++axis) {
        load_[3 * node + axis] = static_cast<Scalar>(mass[node] * gravity[axis]);
        if (!mesh.fixed[node][axis]) inverse_mass_[3 * node + axis] = static_cast<Scalar>(1 / mass[node]);
      }
  }

  void step(double dt) {
    const auto h = static_cast<Scalar>(dt);
    stage_u_ = u_, stage_v_ = v_;
    stage(Scalar(0.5) * h, h / 6, /*first=*/true);
    stage(Scalar(0.5) * h, h / 3, false);
    stage(h, h / 3, false);
    stage(0, h / 6, false);
    u_ += sum_u_, v_ += sum_v_;
  }

  Eigen::Matrix<Scalar, 3, 1> displacement(int node) const { return u_.template segment<3>(3 * node); }

 private:
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  using Corners = Eigen::Matrix<Scalar, 12, 1>;

  /// Rates at the stage's state, their share of the sum, and the next stage's state.
  void stage(Scalar ahead, Scalar weight, bool first) {
    add_forces();
    rate_ = inverse_mass_.cwiseProduct(force_) - damping_ * stage_v_;
    if (first) sum_u_.setZero(), sum_v_.setZero();
    sum_u_ += weight * stage_v_;
    sum_v_ += weight * rate_;
    stage_u_ = u_ + ahead * stage_v_;
    stage_v_ = v_ + ahead * rate_;
  }

  void add_forces() {
    force_ = load_;
    for (std::size_t t = 0; t < tetrahedra_.size(); ++t) {
      Corners u;
      for (int c = 0; c < 4; ++c) u.template segment<3>(3 * c) = stage_u_.template segment<3>(3 * tetrahedra_[t][c]);
      const Corners f = stiffness_[t] * u;
      for (int c = 0; c < 4; ++c) force_.template segment<3>(3 * tetrahedra_[t][c]) -= f.template segment<3>(3 * c);
    }
  }

  std::vector<std::array<int, 4>> tetrahedra_;
  std::vector<Eigen::Matrix<Scalar, 12, 12>> stiffness_;
  Scalar damping_;
  Vector u_, v_, inverse_mass_, load_, force_, stage_u_, stage_v_, rate_, sum_u_, sum_v_;
};

}  // namespace palpate::bench

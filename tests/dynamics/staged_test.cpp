#include "common/dynamics/staged.hpp"

#include "tests/dynamics/model_checks.hpp"

namespace palpate::testing {
namespace {

/// Every node hangs on a spring whose other end follows it late.
class LateSprings final : public Staged<double> {
 public:
  LateSprings(const ElasticMesh& mesh, double stiffness)
      : Staged(mesh, Integrator::rk4, 1), stiffness_(stiffness), late_(4 * mesh.rest.size(), 0) {
    set_element_bounds(std::vector<double>(mesh.tetrahedra.size(), 1e4));
  }
  void state(State& s) override {
    Staged::state(s);
    s.all(late_);
  }

 protected:
  void add_forces(const double* u, double* force) const override {
    for (std::size_t i = 0; i < late_.size(); ++i) force[i] -= stiffness_ * (u[i] - late_[i]);
  }
  double elastic_energy() const override { return 0; }
  void take_out(int) override {}
  void remember(const double* u, double dt) override {
    for (std::size_t i = 0; i < late_.size(); ++i) late_[i] += dt / 0.1 * (u[i] - late_[i]);
  }

 private:
  double stiffness_;
  std::vector<double> late_;  ///< [m]
};

TEST(Staged, WhatAModelRemembersBesideItsMotionIsSavedAndGoesOn) {
  const ElasticMesh mesh = free_block({2, 2, 2});
  LateSprings first(mesh, 3), second(mesh, 3);
  const std::size_t motion = 2 * 4 * mesh.rest.size() * sizeof(double);
  EXPECT_EQ(first.state_size(), motion + motion / 2);
  set_field(first, random_field(mesh.rest.size(), 1e-3, 1));
  for (int i = 0; i < 50; ++i) first.step(1e-3);
  second.restore(saved(first).data());
  EXPECT_EQ(first.elastic_force(3), second.elastic_force(3));
  for (int i = 0; i < 50; ++i) first.step(1e-3), second.step_semi_implicit(1e-3);
  EXPECT_NE(saved(first), saved(second)) << "else the next says nothing";
  second.restore(saved(first).data());
  for (LateSprings* model : {&first, &second})
    for (int i = 0; i < 50; ++i) model->step(1e-3);
  EXPECT_EQ(saved(first), saved(second));
}

TEST(Staged, TheElasticForceFollowsWhatAModelRemembers) {
  LateSprings model(free_block({1, 1, 1}), 3);
  const Eigen::Vector3d pulled(1e-3, 0, 0), still = Eigen::Vector3d::Zero();
  model.set_motion(0, pulled, still);
  EXPECT_DOUBLE_EQ(model.elastic_force(0).x(), -3e-3);
  for (int i = 0; i < 3000; ++i) {
    model.step(1e-3);
    model.set_motion(0, pulled, still);
  }
  EXPECT_LT(model.elastic_force(0).norm(), 1e-4) << "the other end has come after it";
}

}  // namespace
}  // namespace palpate::testing

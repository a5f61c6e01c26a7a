#pragma once
#include <Eigen/Dense>
#include <random>

#include "common/dynamics/dynamic_model.hpp"
#include "tests/dynamics/dynamic_meshes.hpp"

namespace palpate::testing {

/// Others' forces on a few nodes by a dense symmetric positive matrix.
struct DenseCoupling final : Coupling {
  DenseCoupling(std::vector<int> coupled, unsigned seed) : nodes(std::move(coupled)) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto size = static_cast<Eigen::Index>(3 * nodes.size());
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(size, size, [&] { return uniform(random); });
    matrix = 2 * root * root.transpose();
  }
  void apply(const double* u, double* force) override {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) force[i] -= matrix(i, j) * u[j];
  }

  std::vector<int> nodes;
  Eigen::MatrixXd matrix;  // [N/m]
};

/// The same motion as textbooks write it: the rates at each stage from the assembled forces, in double
/// precision.
class Textbook {
 public:
  Textbook(const DynamicBody& body, Integrator integrator, double damping)
      : body_(body),
        integrator_(integrator),
        damping_(damping),
        size_(3 * static_cast<Eigen::Index>(body.mesh.rest.size())) {
    u_ = v_ = load_ = mass_ = added_ = Vector::Zero(size_);
    free_ = Vector::Ones(size_);
    for (const auto& tet : body.mesh.tetrahedra) {
      const auto& x = body.mesh.rest;
      const double volume = tet_gradients({x[tet[0]], x[tet[1]], x[tet[2]], x[tet[3]]}).volume;
      for (int n : tet) mass_.segment<3>(3 * n).array() += body.mesh.material(0).density * volume / 4;
    }
    for (int n = 0; n < body.mesh.nodes(); ++n)
      for (int axis = 0; axis < 3; ++axis)
        if (body.mesh.fixed[n][axis]) free_[3 * n + axis] = 0;
  }

  void couple(const DenseCoupling& coupling, const std::vector<double>& mass) {
    coupling_ = &coupling;
    for (std::size_t c = 0; c < mass.size(); ++c) added_.segment<3>(3 * coupling.nodes[c]).array() += mass[c];
  }
  void set(int n, const Eigen::Vector3d& u, const Eigen::Vector3d& v, const Eigen::Vector3d& load) {
    u_.segment<3>(3 * n) = u, v_.segment<3>(3 * n) = v, load_.segment<3>(3 * n) = load;
  }
  double own_mass(int n) const { return mass_[3 * n]; }

  void step(double h) {
    if (integrator_ != Integrator::rk4) {
      const Vector before = v_, after = v_ + h * acceleration(u_, v_);
      u_ += h * (integrator_ == Integrator::semi_implicit ? after : before);
      v_ = after;
      return;
    }
    const Vector u1 = v_, v1 = acceleration(u_, v_);
    const Vector u2 = v_ + h / 2 * v1, v2 = acceleration(u_ + h / 2 * u1, u2);
    const Vector u3 = v_ + h / 2 * v2, v3 = acceleration(u_ + h / 2 * u2, u3);
    const Vector u4 = v_ + h * v3, v4 = acceleration(u_ + h * u3, u4);
    u_ += h / 6 * (u1 + 2 * u2 + 2 * u3 + u4);
    v_ += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
  }

  std::vector<Eigen::Vector3d> displacement() const { return field(u_); }
  std::vector<Eigen::Vector3d> velocity() const { return field(v_); }

 private:
  using Vector = Eigen::VectorXd;

  static std::vector<Eigen::Vector3d> field(const Vector& values) {
    std::vector<Eigen::Vector3d> field;
    for (Eigen::Index i = 0; i < values.size(); i += 3) field.emplace_back(values.segment<3>(i));
    return field;
  }

  Vector acceleration(const Vector& u, const Vector& v) const {
    Vector force = load_;
    const auto inner = internal_force(body_.problem.mesh, body_.problem.materials, field(u));
    for (std::size_t n = 0; n < inner.size(); ++n) force.segment<3>(3 * n) -= inner[n];
    if (coupling_) {
      Vector part(coupling_->matrix.rows());
      for (std::size_t c = 0; c < coupling_->nodes.size(); ++c)
        part.segment<3>(3 * c) = u.segment<3>(3 * coupling_->nodes[c]);
      const Vector others = coupling_->matrix * part;
      for (std::size_t c = 0; c < coupling_->nodes.size(); ++c)
        force.segment<3>(3 * coupling_->nodes[c]) -= others.segment<3>(3 * c);
    }
    return free_.cwiseProduct(force.cwiseQuotient(mass_ + added_) - damping_ * v);
  }

  const DynamicBody& body_;
  Integrator integrator_;
  double damping_;
  Eigen::Index size_;
  Vector u_, v_, load_, mass_, added_, free_;
  const DenseCoupling* coupling_ = nullptr;
};

}  // namespace palpate::testing

#include "common/models/modal_shell/modal_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/kernels/kernels.hpp"
#include "common/mesh/shell_quality.hpp"
#include "common/models/modal_shell/modal_shape.hpp"
#include "common/models/modal_shell/spec.hpp"

namespace palpate {
namespace {

constexpr double kMinEnergy = 1e-40;  // [J]
constexpr double kSettling = 0.5;     // [s] in which a wall comes to rest under tools that stand

ModalConstants constants_of(const ModalTensors& modal, const Shell& shell, double h) {
  return make_modal_constants(modal.omega, modal_damping(modal.omega, shell.damping_ratio, shell.damping), h);
}

// C* = R + Phi diag(4 / K^) Phi^T from the archive's static compliance C; without residual flexibility R = 0.
Compliance<double> step_compliance(const Archive& archive, const ModalConstants& constants, bool residual) {
  Compliance<double> compliance(archive, Compliance<double>::Rows::touchable);
  std::vector<double> weight(constants.inverse);
  if (residual) {
    for (std::size_t m = 0; m < weight.size(); ++m) weight[m] -= 1 / constants.omega2[m];
  } else {
    compliance.clear();
  }
  compliance.add_modes(archive.modal->shape, weight);
  return compliance;
}

std::vector<double> softness_of(std::span<const Tool> tools) {
  std::vector<double> softness;
  for (const Tool& tool : tools) softness.push_back(tool.compliance);
  return softness;
}

}  // namespace

ModalBody::ModalBody(const Archive& archive, const ShellSpec& body, const StepSettings& settings)
    : ModalBody(archive, body, settings, constants_of(modes_of(archive), body.shell, settings.dt)) {}

ModalBody::ModalBody(const Archive& archive, const ShellSpec& body, const StepSettings& settings,
                     ModalConstants constants)
    : TouchBody(archive.surface, step_compliance(archive, constants, body.shell.residual), settings,
                {.offset = archive.modal->thickness / 2, .softness = softness_of(settings.tools)}),
      constants_(std::move(constants)),
      dt_(settings.dt),
      residual_(body.shell.residual),
      half_thickness_(archive.modal->thickness / 2),
      shape_(archive.modal->shape),
      rows_(shape_.size()),
      mouths_(boundary_loops(archive.surface.triangles)) {
  const std::size_t modes = archive.modal->omega.size(), rows = shape_.size() / modes;
  for (std::size_t m = 0; m < modes; ++m)
    for (std::size_t i = 0; i < rows; ++i) rows_[i * modes + m] = shape_[m * rows + i];
  for (std::vector<double>* v : {&x_, &v_, &tool_force_, &wall_force_, &free_, &moved_}) v->assign(modes, 0.0);
  pushed_.reserve(kMaxWallForces);
  all_.assign(rows, 0.0);
  displacement_.reserve(rows);
  place_.assign(archive.surface.position.size(), -1);
  near_displacement_.reserve(rows);
  columns_.reserve(modes + 27 * kMaxContacts);
  coefficients_.reserve(modes + 27 * kMaxContacts);
  if (residual_) tabulate_residuals();
}

void ModalBody::update_surface(std::span<const MovingTool> tools) {
  columns_.clear();
  for (int m = 0; m < modes(); ++m) columns_.push_back(shape_.data() + all_.size() * m);
  kernels::active().combine_d(columns_.data(), x_.data(), modes(), static_cast<std::ptrdiff_t>(all_.size()),
                              all_.data());
  const std::span<const int> near = mark(tools);
  if (residual_) add_residual(near);
  const std::span<const int> marked = mark_all();
  displacement_.resize(3 * marked.size());
  for (std::size_t i = 0; i < marked.size(); ++i)
    std::copy_n(all_.data() + 3 * marked[i], 3, displacement_.data() + 3 * i);
  move_marked(displacement_);
  pushed_.clear();
  std::ranges::fill(wall_force_, 0.0);
  palpate::free_motion(constants_, x_.data(), v_.data(), tool_force_.data(), free_.data());
}

// Near the tools the static share of their last forces: R f = C* f - Phi (4 / K^) Phi^T f. It does not reach far.
void ModalBody::add_residual(std::span<const int> near) {
  coefficients_.clear();
  for (int m = 0; m < modes(); ++m) coefficients_.push_back(-constants_.inverse[m] * tool_force_[m]);
  law().for_each_nodal_force([&](int, int node, const Eigen::Vector3d& f) {
    if (node >= compliance().column_nodes()) return;
    for (int axis = 0; axis < 3; ++axis) {
      columns_.push_back(compliance().column(node, axis));
      coefficients_.push_back(f[axis]);
    }
  });
  if (static_cast<int>(columns_.size()) == modes()) return;
  near_displacement_.resize(3 * near.size());
  kernels::active().combine_nodes_d(columns_.data(), coefficients_.data(), static_cast<int>(columns_.size()),
                                    near.data(), static_cast<int>(near.size()), near_displacement_.data());
  for (std::size_t i = 0; i < near.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) all_[3 * near[i] + axis] += near_displacement_[3 * i + axis];
}

void ModalBody::push(std::span<const WallForce> forces) {
  for (const WallForce& w : forces) {
    if (pushed_.size() == pushed_.capacity()) break;
    pushed_.push_back(w);
    for (int v = 0; v < 3; ++v)
      if (w.anchor.weights[v] != 0) add_modal_force(w.anchor.nodes[v], w.anchor.weights[v] * w.force, wall_force_);
  }
  for (int m = 0; m < modes(); ++m) moved_[m] = wall_force_[m] + tool_force_[m];
  palpate::free_motion(constants_, x_.data(), v_.data(), moved_.data(), free_.data());
}

LawOutcome ModalBody::hold(std::span<const MovingTool> tools) {
  palpate::free_motion(constants_, x_.data(), v_.data(), wall_force_.data(), free_.data());
  for (int m = 0; m < modes(); ++m) moved_[m] = x_[m] + free_[m];
  for (const TouchContact& c : law().contacts())
    for (int v = 0; v < 3; ++v) move_rest(c.anchor.nodes[v], modal_displacement(c.anchor.nodes[v], moved_));
  LawOutcome outcome = TouchBody::hold(tools);

  std::ranges::fill(tool_force_, 0.0);
  law().for_each_nodal_force([&](int, int node, const Eigen::Vector3d& f) { add_modal_force(node, f, tool_force_); });
  for (int m = 0; m < modes(); ++m) free_[m] += constants_.inverse[m] * tool_force_[m];
  advance(constants_, x_.data(), v_.data(), free_.data());
  for (int m = 0; m < modes(); ++m) {
    outcome.finite &= std::isfinite(x_[m]);
    // A mode that has swung out stands still: what is left of it would become denormal, and slow.
    if (x_[m] * x_[m] * constants_.omega2[m] + v_[m] * v_[m] < kMinEnergy) x_[m] = v_[m] = 0;
  }
  return outcome;
}

void ModalBody::settle(std::span<const MovingTool> tools) {
  if (law().contacts().empty()) return;
  stand(tools, static_cast<int>(kSettling / dt_));
  std::ranges::fill(v_, 0.0);
}

void ModalBody::add_modal_force(int node, const Eigen::Vector3d& force, std::vector<double>& modal) const {
  const std::size_t r = modal.size();
  const double* row = rows_.data() + 3 * r * node;
  for (std::size_t m = 0; m < r; ++m) modal[m] += force[0] * row[m] + force[1] * row[r + m] + force[2] * row[2 * r + m];
}

Eigen::Vector3d ModalBody::modal_displacement(int node, const std::vector<double>& coordinates) const {
  const Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>> rows(
      rows_.data() + 3 * coordinates.size() * node, 3, modes());
  return rows * Eigen::Map<const Eigen::VectorXd>(coordinates.data(), modes());
}

void ModalBody::rows(const Anchor& anchor, double* rows) const {
  const std::size_t size = 3 * x_.size();
  std::fill_n(rows, size, 0.0);
  for (int v = 0; v < 3; ++v) {
    if (anchor.weights[v] == 0) continue;
    const double* of_node = rows_.data() + size * anchor.nodes[v];
    for (std::size_t i = 0; i < size; ++i) rows[i] += anchor.weights[v] * of_node[i];
  }
}

// R = C* - Phi (4 / K^) Phi^T among the corners of every triangle.
void ModalBody::tabulate_residuals() {
  const auto r = static_cast<Eigen::Index>(x_.size());
  const auto weight = Eigen::Map<const Eigen::VectorXd>(constants_.inverse.data(), r).asDiagonal();
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;
  const auto rows_of = [&](int node) { return Eigen::Map<const Rows>(rows_.data() + 3 * r * node, 3, r); };
  first_triangle_.assign(all_.size() / 3 + 1, 0);
  for (int t = 0; t < surface().triangle_count(); ++t) ++first_triangle_[surface().triangle(t)[0] + 1];
  for (std::size_t n = 1; n < first_triangle_.size(); ++n) first_triangle_[n] += first_triangle_[n - 1];
  residuals_.resize(surface().triangle_count());
  std::vector<int> filled(first_triangle_.begin(), first_triangle_.end() - 1);
  for (int t = 0; t < surface().triangle_count(); ++t) {
    TriangleResidual& to = residuals_[filled[surface().triangle(t)[0]]++];
    to.nodes = surface().triangle(t);
    to.block.setZero();
    for (int v = 0; v < 3; ++v)
      for (int w = 0; w < 3; ++w) {
        const int a = to.nodes[v], b = to.nodes[w];
        if (std::max(a, b) >= compliance().column_nodes()) continue;
        auto block = to.block.block<3, 3>(3 * v, 3 * w);
        for (int j = 0; j < 3; ++j) block.col(j) = Eigen::Map<const Eigen::Vector3d>(compliance().column(b, j) + 3 * a);
        block -= rows_of(a) * weight * rows_of(b).transpose();
      }
  }
}

Eigen::Matrix3d ModalBody::residual(const Anchor& anchor) const {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  if (!residual_) return sum;
  for (int i = first_triangle_[anchor.nodes[0]]; i < first_triangle_[anchor.nodes[0] + 1]; ++i) {
    const TriangleResidual& of = residuals_[i];
    if (of.nodes != anchor.nodes) continue;
    for (int v = 0; v < 3; ++v)
      for (int w = 0; w < 3; ++w) sum += anchor.weights[v] * anchor.weights[w] * of.block.block<3, 3>(3 * v, 3 * w);
    break;
  }
  return sum;
}

double ModalBody::penetration(const Segment& axis, double radius) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (int t = 0; t < surface().triangle_count(); ++t)
    nearest = std::min(nearest, closest_points(axis, surface().corners(t)).squared_distance);
  return std::max(0.0, radius + half_thickness_ - std::sqrt(nearest));
}

double ModalBody::energy() const {
  double twice = 0;
  for (int m = 0; m < modes(); ++m) twice += v_[m] * v_[m] + constants_.omega2[m] * x_[m] * x_[m];
  return twice / 2;
}

void ModalBody::state(State& s, std::span<const MovingTool> tools) {
  TouchBody::state(s, tools);
  for (std::vector<double>* v : {&x_, &v_, &tool_force_}) s.all(*v);
}

std::unique_ptr<BodyPart> make_haptic_part(const ModalShellSpec& spec, const Archive& archive,
                                           const StepSettings& settings) {
  return std::make_unique<ModalBody>(archive, spec, settings);
}

}  // namespace palpate

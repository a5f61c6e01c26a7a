#pragma once
#include <cmath>
#include <deque>
#include <numbers>
#include <set>

#include "common/archive/compliance.hpp"
#include "common/devices/emulated_hand.hpp"
#include "common/dynamics/stability.hpp"
#include "common/dynamics/tensor_mass.hpp"
#include "common/geometry/triangle.hpp"
#include "tests/haptic/block_scene.hpp"

/// A hand that presses a device's tool on a block of moving tissue, and the ways to close that loop.
namespace palpate::testing {

/// A block of tensor-mass tissue whose middle node the tip presses down with its lowest point, without friction: the
/// full model.
class TouchedBlock {
 public:
  /// `cells` along the block's sides of 0.1 m; half of that along its height of 0.05 m.
  TouchedBlock(double young, double damping, int cells = 6) {
    const TetMesh mesh = block_mesh(cells);
    QuasiStaticSpec body;
    body.name = "block";
    body.material = {.young = young, .poisson = 0.4, .density = 1000};
    body.fixed.push_back({.where = {.box = Box{{-1, -1, -0.0501}, {1, 1, -0.0499}}}});
    const Archive archive = precompute(body, mesh);
    const Compliance<double> compliance(archive, Compliance<double>::Rows::touchable);
    for (int k = 0; k < archive.surface.touchable; ++k) {
      Eigen::Matrix3d c;
      for (int axis = 0; axis < 3; ++axis)
        c.col(axis) = Eigen::Map<const Eigen::Vector3d>(compliance.column(k, axis) + 3 * k);
      const Eigen::Vector3d& at = archive.surface.position[k];
      if (at.head<2>().norm() < 1e-9 && at.z() > -1e-9) held_ = archive.surface.node_number[k], compliance_ = c;
      bool whole = true;
      for (const bool fixed : archive.surface.fixed[k]) whole = whole && !fixed;
      if (whole) stiffness_.emplace_back(archive.surface.node_number[k], c.inverse());
    }
    for (const auto& t : archive.surface.triangles) {
      std::array<int, 3> nodes;
      for (int v = 0; v < 3; ++v) nodes[v] = archive.surface.node_number[t[v]];
      triangles_.push_back(nodes);
    }
    for (const auto& nodes : triangles_) surface_nodes_.insert(nodes.begin(), nodes.end());
    mesh_.rest.assign(mesh.nodes.begin(), mesh.nodes.end());
    mesh_.tetrahedra.assign(mesh.tetrahedra.begin(), mesh.tetrahedra.end());
    for (const Eigen::Vector3d& x : mesh_.rest) {
      const bool base = x.z() < -0.0499;
      mesh_.fixed.push_back({base, base, base});
    }
    mesh_.materials = {body.material};
    model_ = std::make_unique<TensorMass<double>>(mesh_, Integrator::rk4, damping);
    largest_ = max_step(Integrator::rk4, model_->frequency_bound(), damping);
  }

  /// Moves the tissue on by `dt` while the tip's centre goes from a to b.
  void tick(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius, double dt) {
    const int steps = static_cast<int>(std::ceil(dt / (0.7 * largest_)));
    const double h = dt / steps;
    force_.setZero();
    for (int s = 1; s <= steps; ++s) {
      model_->step(h);
      const Eigen::Vector3d lowest = a + (b - a) * s / steps + radius * normal_;
      const Eigen::Vector3d shift = std::max(0.0, (lowest - position(held_)).dot(normal_)) * normal_;
      if (shift.isZero(0)) continue;
      model_->set_motion(held_, model_->displacement(held_) + shift, model_->velocity(held_) + shift / h);
      force_ += model_->mass(held_) * shift / (h * h * steps);
    }
  }
  Eigen::Vector3d force() const { return force_; }  ///< [N] on the tissue, mean over the last tick

  /// What a deform node would tell of it; `stiffer` multiplies the stiffness that it claims.
  LocalContactModel describe(const ToolDofs& dofs, std::uint64_t step, double stiffer = 1) const {
    LocalContactModel m;
    m.run = 1, m.seq = step + 1, m.tool_run = 1, m.tool_step = step;
    m.yaw = dofs.yaw, m.pitch = dofs.pitch, m.depth = dofs.depth, m.roll = dofs.roll, m.grip = dofs.grip;
    const auto copy3 = [](const Eigen::Vector3d& v) { return std::array<double, 3>{v[0], v[1], v[2]}; };
    const auto copy9 = [](const Eigen::Matrix3d& k) {
      std::array<double, 9> a;
      for (int i = 0; i < 9; ++i) a[i] = k(i / 3, i % 3);
      return a;
    };
    if (force_.dot(normal_) > 0) {
      const Eigen::Matrix3d k = normal_ * normal_.transpose() / normal_.dot(compliance_ * normal_);
      m.contacts.push_back({0, 0, copy3(position(held_)), copy3(normal_), copy3(force_), copy9(stiffer * k)});
    }
    std::vector<int> of_node(mesh_.nodes(), -1);
    std::vector<Eigen::Vector3d> at_node(mesh_.nodes());
    for (const int node : surface_nodes_) at_node[node] = position(node);
    for (const auto& nodes : triangles_) {
      const Triangle corners{at_node[nodes[0]], at_node[nodes[1]], at_node[nodes[2]]};
      const double longest = std::max((corners[1] - corners[0]).norm(), (corners[2] - corners[0]).norm());
      if ((at_node[held_] - corners[0]).norm() > longest + 0.02) continue;  // at once, without its nearest point
      if (closest_point(at_node[held_], corners).squared_distance > 0.02 * 0.02) continue;
      std::uint32_t at[3];
      for (int v = 0; v < 3; ++v) {
        int& place = of_node[nodes[v]];
        if (place < 0) {
          place = static_cast<int>(m.nodes.size());
          Eigen::Matrix3d k = Eigen::Matrix3d::Zero();
          for (const auto& [node, stiffness] : stiffness_)
            if (node == nodes[v]) k = stiffer * stiffness;
          m.nodes.push_back({0, static_cast<std::uint32_t>(nodes[v]), copy3(at_node[nodes[v]]),
                             copy3(model_->velocity(nodes[v])), copy9(k)});
        }
        at[v] = static_cast<std::uint32_t>(place);
      }
      m.triangles.push_back({at[0], at[1], at[2]});
    }
    return m;
  }

 private:
  Eigen::Vector3d position(int node) const { return mesh_.rest[node] + model_->displacement(node); }

  ElasticMesh mesh_;
  std::unique_ptr<TensorMass<double>> model_;
  double largest_ = 0;
  int held_ = 0;
  Eigen::Matrix3d compliance_ = Eigen::Matrix3d::Zero();
  std::vector<std::pair<int, Eigen::Matrix3d>> stiffness_;
  std::vector<std::array<int, 3>> triangles_;
  std::set<int> surface_nodes_;
  const Eigen::Vector3d normal_ = -Eigen::Vector3d::UnitZ();
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
};

using Hand = EmulatedHand;

/// What one run of the loop gave, per haptic step.
struct LoopTrace {
  std::vector<Eigen::Vector3d> at, felt, full;  ///< [m] tip; [N] on the tool, as rendered, and of the full model there
};

}  // namespace palpate::testing

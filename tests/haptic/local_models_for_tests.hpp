#pragma once
#include "idl/messages.hpp"
#include "tests/haptic/block_scene.hpp"

/// Local contact models made by hand.
namespace palpate::testing {

inline std::array<double, 3> plain(const Eigen::Vector3d& v) {
  return {v[0], v[1], v[2]};
}
inline std::array<double, 9> isotropic(double k) {
  return {k, 0, 0, 0, k, 0, 0, 0, k};
}

/// A model with the tool's pose at `tip` and nothing near it.
inline LocalContactModel empty_model(const Tool& tool, const Eigen::Vector3d& tip, std::uint64_t step,
                                     std::uint64_t seq = 1) {
  const ToolDofs dofs = tip_at(tool, tip);
  LocalContactModel m;
  m.run = 77, m.seq = seq, m.tool_run = 5, m.tool_step = step;
  m.yaw = dofs.yaw, m.pitch = dofs.pitch, m.depth = dofs.depth, m.roll = dofs.roll, m.grip = dofs.grip;
  return m;
}

/// Adds a horizontal square of 0.1 m at height `z` about (x, y), facing up, of two triangles.
inline void add_square(LocalContactModel& m, double z, double stiffness,
                       const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero()) {
  const auto first = static_cast<std::uint32_t>(m.nodes.size());
  for (const auto& [x, y] : {std::pair{-0.05, -0.05}, {0.05, -0.05}, {0.05, 0.05}, {-0.05, 0.05}})
    m.nodes.push_back({0, first, {x, y, z}, plain(velocity), isotropic(stiffness)});
  m.triangles.push_back({first, first + 1, first + 2});
  m.triangles.push_back({first, first + 2, first + 3});
}

/// Adds a place held below the tip at height `z`, pressed down with `force` [N].
inline void add_contact(LocalContactModel& m, const Eigen::Vector3d& at, const Eigen::Vector3d& force,
                        double stiffness) {
  m.contacts.push_back({0, 0, plain(at), {0, 0, -1}, plain(force), isotropic(stiffness)});
}

}  // namespace palpate::testing

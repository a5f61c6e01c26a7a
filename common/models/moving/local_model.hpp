#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <type_traits>

#include "common/models/moving/tissue_limits.hpp"
#include "common/tool/pose_values.hpp"
#include "idl/limits.hpp"

namespace palpate {

/// A LocalContactModel as plain memory of fixed size: it crosses threads and enters keyframes as bytes.
struct LocalModel {
  static constexpr int kMaxContacts = Limits<LocalContactModel>::contacts;
  static constexpr int kMaxNodes = Limits<LocalContactModel>::nodes;
  static constexpr int kMaxTriangles = Limits<LocalContactModel>::triangles;

  struct Contact {
    std::array<double, 3> position, normal, force;  ///< [m], unit into the tissue, [N] on the tissue; world
    std::array<double, 9> stiffness;                ///< [N/m] row-major
    std::uint64_t grasped;
  };
  struct Node {
    std::array<double, 3> position, velocity;  ///< [m], [m/s] world
    std::array<double, 9> stiffness;           ///< [N/m] row-major
  };

  std::uint64_t run = 0, seq = 0;  ///< of the message; seq 0: none has come yet
  std::uint64_t tool_step = 0;     ///< haptic step whose pose is in it
  std::int64_t late_ns = 0;        ///< by which the tissue's own time is behind its node's clock
  PoseValues pose{};               ///< that pose
  double stiffness = 0;            ///< [N/m] that the tissue in it has at most, by TissueLimits
  double modulus = 0;              ///< [Pa] E / (1 - nu^2) at its surface, likewise
  std::int32_t contacts = 0, nodes = 0, triangles = 0, unused = 0;
  std::array<Contact, kMaxContacts> contact{};
  std::array<Node, kMaxNodes> node{};
  std::array<std::array<std::uint32_t, 3>, kMaxTriangles> triangle{};
};
static_assert(std::is_trivially_copyable_v<LocalModel>);

/// Copies a message that passed valid(). False, and `to` is as it was, if it cannot be of this tissue. Allocates
/// nothing.
bool copy_model(const LocalContactModel& from, const TissueLimits& limits, LocalModel& to);

}  // namespace palpate

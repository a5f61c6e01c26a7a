#pragma once
#include <cmath>

#include "common/bus/fields.hpp"

/// What a sample from outside must fulfil before a node sees it: finite numbers, times of this age, bounded lengths,
/// sizes that fit each other, indices into its own sequences, unit normals of local contacts, a task record that can
/// be. Other indices are checked against the scene by the node that uses them.
namespace palpate {

/// Bounds on lengths, the same as in idl/palpate.idl.
struct Limits {
  static constexpr std::int64_t time_ns =
      2'000'000'000'000'000'000;                          ///< so that two may be added and a third taken off
  static constexpr std::size_t contacts = 4096;           ///< nodal forces, and contacts, of one tool
  static constexpr std::size_t surface_floats = 3000000;  ///< one million surface nodes
  static constexpr std::size_t keyframe_bytes = 16777216;
  static constexpr std::size_t text_bytes = 1048576;
  static constexpr std::size_t tetrahedra = 4000000;  ///< removed at once
  static constexpr std::size_t local_contacts = 32;   ///< of one LocalContactModel
  static constexpr std::size_t local_nodes = 192;
  static constexpr std::size_t local_triangles = 128;
  static constexpr std::size_t consumed_steps = 64;
  static constexpr std::size_t modes = 1024;  ///< of one modal body
  static constexpr std::size_t shell_forces = 4096;
  static constexpr std::size_t particles = 1024;  ///< of one catheter
};

namespace detail {
template <class T>
bool finite(const T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    return std::isfinite(value);
  } else if constexpr (std::same_as<T, std::int64_t>) {
    return value >= -Limits::time_ns && value <= Limits::time_ns;
  } else if constexpr (is_vector<T> || is_array<T>) {
    bool all = true;
    if constexpr (!std::is_integral_v<typename T::value_type>)
      for (const auto& element : value) all = all && finite(element);
    return all;
  } else if constexpr (HasFields<const T>) {
    bool all = true;
    fields([&](const char*, const auto& field) { all = all && finite(field); }, value);
    return all;
  } else {
    return true;
  }
}

template <class M>
bool sizes_fit(const M&) {
  return true;
}
inline bool sizes_fit(const ContactState& m) {
  if (m.forces.size() > Limits::contacts || m.contacts.size() > Limits::contacts) return false;
  for (const HeldContact& contact : m.contacts)
    if (contact.sticking > 1) return false;
  return true;
}
inline bool sizes_fit(const SurfaceState& m) {
  return m.position.size() == m.normal.size() && m.position.size() % 3 == 0 &&
         m.position.size() <= Limits::surface_floats;
}
inline bool sizes_fit(const NodeStatus& m) {
  return !m.node.empty() && m.text.size() <= Limits::text_bytes;
}
inline bool sizes_fit(const ClockProbe& m) {
  return !m.node.empty() && m.seq > 0;
}
inline bool sizes_fit(const ClockAnswer& m) {
  return !m.node.empty() && m.seq > 0;
}
inline bool sizes_fit(const PictureState& m) {
  return !m.node.empty() && m.seq > 0;
}
inline bool sizes_fit(const HapticKeyframe& m) {
  return m.dt > 0 && m.state.size() <= Limits::keyframe_bytes;
}
inline bool sizes_fit(const DeformKeyframe& m) {
  return m.dt > 0 && m.state.size() <= Limits::keyframe_bytes;
}
inline bool sizes_fit(const TopologyChange& m) {
  return m.seq > 0 && m.cause <= gone_before && m.removed.size() <= Limits::tetrahedra;
}
inline bool sizes_fit(const HeldTopology& m) {
  return !m.node.empty() && m.seq > 0 && m.removed.size() <= Limits::tetrahedra;
}
inline bool sizes_fit(const LocalContactModel& m) {
  if (m.seq == 0 || m.contacts.size() > Limits::local_contacts || m.nodes.size() > Limits::local_nodes ||
      m.triangles.size() > Limits::local_triangles)
    return false;
  for (const LocalContact& c : m.contacts) {
    const auto& n = c.normal;
    if (c.grasped > 1 || !(std::abs(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-6)) return false;
  }
  for (const LocalTriangle& t : m.triangles)
    if (t.a >= m.nodes.size() || t.b >= m.nodes.size() || t.c >= m.nodes.size()) return false;
  return true;
}
inline bool sizes_fit(const DeformStep& m) {
  return m.consumed.size() <= Limits::consumed_steps;
}
inline bool sizes_fit(const ModalState& m) {
  return m.coordinates.size() <= Limits::modes && m.forces.size() <= Limits::shell_forces;
}
inline bool sizes_fit(const CatheterState& m) {
  return m.position.size() % 3 == 0 && m.position.size() <= 3 * Limits::particles;
}
inline bool sizes_fit(const TaskRecord& m) {
  return m.inserted >= 0 && m.deepest >= m.inserted && m.inserting_s >= 0 && m.largest_force >= 0 && m.held_s >= 0;
}
inline bool sizes_fit(const SceneText& m) {
  return m.text.size() <= Limits::text_bytes;
}
}  // namespace detail

/// True if a node may use the message.
template <class M>
bool valid(const M& message) {
  return detail::sizes_fit(message) && detail::finite(message);
}

}  // namespace palpate

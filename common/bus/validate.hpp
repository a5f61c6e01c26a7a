#pragma once
#include <cmath>

#include "common/bus/fields.hpp"

/// What a sample from outside must fulfil before a node sees it: finite numbers, bounded lengths, sizes that
/// fit each other. Indices are checked against the scene by the node that uses them.
namespace palpate {

/// Bounds on lengths, the same as in idl/palpate.idl.
struct Limits {
  static constexpr std::size_t contacts = 4096;           ///< nodal forces, and contacts, of one tool
  static constexpr std::size_t surface_floats = 3000000;  ///< one million surface nodes
  static constexpr std::size_t keyframe_bytes = 16777216;
  static constexpr std::size_t text_bytes = 1048576;
};

namespace detail {
template <class T>
bool finite(const T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    return std::isfinite(value);
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
inline bool sizes_fit(const HapticKeyframe& m) {
  return m.dt > 0 && m.state.size() <= Limits::keyframe_bytes;
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

#pragma once
#include <concepts>
#include <type_traits>

#include "common/bus/messages.hpp"

/// The one list of the messages' fields, in wire order. `fields(v, a, others...)` calls v("name", a.name,
/// others.name...) for each field; the others may be any structs with the same member names. Log encoding,
/// schema text, comparison, printing and the conversion to the generated C structs all come from it.

#define PALPATE_PARENS ()
#define PALPATE_EXPAND(...) PALPATE_EXPAND3(PALPATE_EXPAND3(PALPATE_EXPAND3(__VA_ARGS__)))
#define PALPATE_EXPAND3(...) PALPATE_EXPAND2(PALPATE_EXPAND2(PALPATE_EXPAND2(__VA_ARGS__)))
#define PALPATE_EXPAND2(...) PALPATE_EXPAND1(PALPATE_EXPAND1(PALPATE_EXPAND1(__VA_ARGS__)))
#define PALPATE_EXPAND1(...) __VA_ARGS__
#define PALPATE_VISIT(name, ...)              \
  visit(#name, message.name, others.name...); \
  __VA_OPT__(PALPATE_VISIT_AGAIN PALPATE_PARENS(__VA_ARGS__))
#define PALPATE_VISIT_AGAIN() PALPATE_VISIT

#define PALPATE_FIELDS(Type, ...)                                         \
  constexpr const char* name_of(const Type*) {                            \
    return #Type;                                                         \
  }                                                                       \
  template <class Visitor, class M, class... Others>                      \
  requires std::same_as<std::remove_const_t<M>, Type>                     \
  constexpr void fields(Visitor&& visit, M& message, Others&... others) { \
    PALPATE_EXPAND(PALPATE_VISIT(__VA_ARGS__))                            \
  }

/// Calls X(M) for every message that a topic carries.
// clang-format off
#define PALPATE_MESSAGES(X)                                                                                         \
  X(ToolState)                                                                                                      \
  X(DeviceState)                                                                                                    \
  X(ContactState)                                                                                                   \
  X(ForceState) X(SurfaceState) X(NodeStatus) X(HapticKeyframe) X(SceneText) X(TopologyChange) X(LocalContactModel) \
      X(DeformStep) X(DeformKeyframe) X(ModalState) X(CatheterState) X(TaskRecord) X(ClockProbe) X(ClockAnswer)     \
          X(PictureState) X(HeldTopology)
// clang-format on

namespace palpate {

PALPATE_FIELDS(NodalForce, body, node, force)
PALPATE_FIELDS(HeldContact, body, nodes, weights, offset, normal, force, sample, sticking)
PALPATE_FIELDS(ToolState, tool, run, seq, step, sense_ns, device_seq, yaw, pitch, depth, roll, grip, opening, pedal,
               local_model_run, local_model_seq, publish_ns)
PALPATE_FIELDS(DeviceState, tool, seq, sense_ns, yaw, pitch, depth, roll, grip, pedal, publish_ns)
PALPATE_FIELDS(ContactState, tool, run, seq, step, sense_ns, press, forces, contacts, publish_ns)
PALPATE_FIELDS(ForceState, tool, run, seq, step, sense_ns, force, torque, grip, trocar, energy, flags, publish_ns)
PALPATE_FIELDS(SurfaceState, body, run, seq, step, sense_ns, publish_ns, position, normal)
PALPATE_FIELDS(NodeStatus, node, role, run, seq, stamp_ns, scene_hash, archive_hash, version, rate_hz, ticks, missed,
               latency_p50_us, latency_p99_us, clock_of, clock_offset_ns, clock_uncertainty_ns, clock_drift_ppm, text)
PALPATE_FIELDS(ClockProbe, node, seq, publish_ns)
PALPATE_FIELDS(ClockAnswer, node, clock_of, host, seq, probe_ns, receive_ns, publish_ns)
PALPATE_FIELDS(PictureState, node, run, seq, step, sense_ns, publish_ns)
PALPATE_FIELDS(HapticKeyframe, run, seq, step, dt, code_path, state, publish_ns)
PALPATE_FIELDS(SceneText, run, seq, scene_hash, text, version, code_path, publish_ns)
PALPATE_FIELDS(TopologyChange, body, run, seq, tick, cause, removed, publish_ns)
PALPATE_FIELDS(HeldTopology, node, body, run, seq, removed, publish_ns)
PALPATE_FIELDS(LocalContact, body, grasped, position, normal, force, stiffness)
PALPATE_FIELDS(LocalNode, body, node, position, velocity, stiffness)
PALPATE_FIELDS(LocalTriangle, a, b, c)
PALPATE_FIELDS(LocalContactModel, tool, run, seq, tick, tool_run, tool_step, sense_ns, yaw, pitch, depth, roll, grip,
               contacts, nodes, triangles, publish_ns)
PALPATE_FIELDS(ConsumedStep, tool, run, step)
PALPATE_FIELDS(DeformStep, run, seq, tick, consumed, hash, publish_ns)
PALPATE_FIELDS(DeformKeyframe, run, seq, tick, dt, code_path, state, publish_ns)
PALPATE_FIELDS(ShellForce, node, force)
PALPATE_FIELDS(ModalState, body, run, seq, step, sense_ns, coordinates, forces, publish_ns)
PALPATE_FIELDS(CatheterState, body, run, seq, step, sense_ns, position, publish_ns)
PALPATE_FIELDS(TaskRecord, body, run, seq, step, sense_ns, inserted, deepest, inserting_s, largest_force, wall_contacts,
               grasps, drops, held_s, publish_ns)

/// True for the structs listed above.
template <class M>
concept HasFields = requires(M& m) {
  fields([](const char*, auto&) {}, m);
};

template <class T>
inline constexpr bool is_vector = false;
template <class T>
inline constexpr bool is_vector<std::vector<T>> = true;
template <class T>
inline constexpr bool is_array = false;
template <class T, std::size_t n>
inline constexpr bool is_array<std::array<T, n>> = true;

/// Equality of all fields; numbers compare by value.
template <class T>
bool same(const T& a, const T& b) {
  if constexpr (is_vector<T> || is_array<T>) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (!same(a[i], b[i])) return false;
    return true;
  } else if constexpr (HasFields<const T>) {
    bool equal = true;
    fields([&](const char*, const auto& x, const auto& y) { equal = equal && same(x, y); }, a, b);
    return equal;
  } else {
    return a == b;
  }
}

}  // namespace palpate

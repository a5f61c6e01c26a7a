#pragma once
#include <string>
#include <tuple>

#include "common/bus/messages.hpp"

/// The table of topics: everything that crosses the bus, and between whom. docs/topics.md shows these rows.
namespace palpate {

/// Depth of a topic whose writer keeps every sample. Only for what is bounded by itself.
inline constexpr int keep_all = 0;

/// Quality of service of a topic. Every writer also asserts a liveliness lease, so that its death shows.
struct Qos {
  bool reliable = true;          ///< lost datagrams are repeated; the writer never waits for a reader
  int depth = 1;                 ///< samples that a writer keeps per key for repair; or keep_all
  bool transient_local = false;  ///< a reader that joins late gets the newest sample of each key, or all that are kept
  int recorder_depth =
      0;  ///< not 0: recorders have a stream of their own, which keeps so many, so that viewers never wait for old ones
};

template <class M>
struct Topic {
  using Message = M;
  const char* name;     ///< on DDS and in logs
  const char* message;  ///< name of the message type
  Qos qos;
  const char* rate;
  const char* writer;   ///< role that writes
  const char* readers;  ///< roles that read, besides recorders and observers
  const char* description;
};

/// The name on DDS of the stream that recorders have of their own.
template <class M>
std::string recorders_name(const Topic<M>& topic) {
  return std::string(topic.name) + "/all";
}

namespace topics {

/// Two seconds at 1 kHz: how far a recorder may fall behind before it loses samples.
inline constexpr int step_depth = 2048;

// clang-format off
inline constexpr Topic<ToolState> tool_state{
    "palpate/tool_state", "ToolState", {true, step_depth, false},
    "every haptic step", "haptic", "deform, render",
    "degrees of freedom of one tool as the step consumed them"};
inline constexpr Topic<DeviceState> device_state{
    "palpate/device_state", "DeviceState", {true, step_depth, false},
    "at the device's rate", "driver", "haptic",
    "degrees of freedom of one tool from a driver elsewhere"};
inline constexpr Topic<ContactState> contact_state{
    "palpate/contact_state", "ContactState", {true, step_depth, false},
    "every haptic step", "haptic", "deform, render",
    "touched nodes with their forces, and the contacts that one tool holds"};
inline constexpr Topic<ContactState> held_contacts{
    "palpate/held_contacts", "ContactState", {true, step_depth, true},
    "when a haptic node dies", "deform, render", "haptic",
    "last contacts of a haptic node that died, for the one that returns"};
inline constexpr Topic<ForceState> force_state{
    "palpate/force_state", "ForceState", {true, step_depth, false},
    "every haptic step", "haptic", "driver, render",
    "force and torque on one tool after the safety chain"};
inline constexpr Topic<SurfaceState> surface_state{
    "palpate/surface_state", "SurfaceState", {true, 1, false, step_depth},
    "visual rate and on contact", "deform", "render",
    "deformed visible surface of one body"};
inline constexpr Topic<NodeStatus> node_status{
    "palpate/node_status", "NodeStatus", {true, step_depth, true},
    "1 Hz and on change", "all", "all",
    "who is there, what it runs and how well it keeps up"};
inline constexpr Topic<ClockProbe> clock_probe{
    "palpate/clock_probe", "ClockProbe", {true, step_depth, false},
    "8 Hz", "all but haptic", "haptic",
    "asks for the haptic node's clock"};
inline constexpr Topic<ClockAnswer> clock_answer{
    "palpate/clock_answer", "ClockAnswer", {true, step_depth, false},
    "on each probe", "haptic", "who asked",
    "times of a probe on the haptic node's clock"};
inline constexpr Topic<PictureState> picture_state{
    "palpate/picture_state", "PictureState", {true, step_depth, false},
    "visual rate", "render", "-",
    "which haptic step a picture shows, and when it was done"};
inline constexpr Topic<HapticKeyframe> haptic_keyframe{
    "palpate/haptic_keyframe", "HapticKeyframe", {true, step_depth, false},
    "1 Hz", "haptic", "-",
    "state of the haptic loop, from which a replay starts"};
inline constexpr Topic<SceneText> scene{
    "palpate/scene", "SceneText", {true, step_depth, true},
    "once per run", "haptic", "-",
    "the resolved scene, for recorders that have no scene file"};
inline constexpr Topic<TopologyChange> topology_change{
    "palpate/topology_change", "TopologyChange", {true, keep_all, true},
    "on each cut or tear", "deform", "haptic, render",
    "tetrahedra that a body has lost; read all, in order"};
inline constexpr Topic<HeldTopology> held_topology{
    "palpate/held_topology", "HeldTopology", {true, step_depth, true},
    "after each cut or tear", "haptic, render", "deform",
    "all that a body is known to have lost, for a deform node that returns"};
inline constexpr Topic<LocalContactModel> local_contact_model{
    "palpate/local_contact_model", "LocalContactModel", {true, step_depth, false},
    "every deform tick near a tool", "deform", "haptic",
    "moving tissue around one tool: its contacts, near surface and stiffness"};
inline constexpr Topic<DeformStep> deform_step{
    "palpate/deform_step", "DeformStep", {true, step_depth, false},
    "every deform tick", "deform", "-",
    "journal of moving tissue: inputs consumed and hash of the state"};
inline constexpr Topic<DeformKeyframe> deform_keyframe{
    "palpate/deform_keyframe", "DeformKeyframe", {true, step_depth, false},
    "1 Hz", "deform", "-",
    "state of moving tissue, from which a replay starts"};
inline constexpr Topic<ModalState> modal_state{
    "palpate/modal_state", "ModalState", {true, step_depth, false},
    "250 Hz", "haptic", "deform, render",
    "modal coordinates of one thin wall and the forces on it"};
inline constexpr Topic<CatheterState> catheter_state{
    "palpate/catheter_state", "CatheterState", {true, step_depth, false},
    "250 Hz", "haptic", "deform, render",
    "particles of one catheter"};
inline constexpr Topic<TaskRecord> task_record{
    "palpate/task_record", "TaskRecord", {true, step_depth, true},
    "10 Hz and at the end", "haptic", "render",
    "how the task with one catheter goes"};
// clang-format on

inline constexpr auto all = std::tuple{
    tool_state,          device_state, contact_state,   held_contacts,   force_state,    surface_state,   node_status,
    clock_probe,         clock_answer, picture_state,   haptic_keyframe, scene,          topology_change, held_topology,
    local_contact_model, deform_step,  deform_keyframe, modal_state,     catheter_state, task_record};

/// Calls f(topic) for every row.
template <class F>
constexpr void for_each(F&& f) {
  std::apply([&](const auto&... topic) { (f(topic), ...); }, all);
}

}  // namespace topics
}  // namespace palpate

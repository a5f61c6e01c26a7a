#pragma once
#include <tuple>

#include "common/bus/messages.hpp"

/// The table of topics: everything that crosses the bus, and between whom. docs/topics.md shows these rows.
namespace palpate {

/// Depth of a topic whose writer keeps every sample. Only for what is bounded by itself.
inline constexpr int keep_all = 0;

/// Quality of service of a topic. Every writer also asserts a liveliness lease, so that its death shows.
struct Qos {
  bool reliable = true;  ///< lost datagrams are repeated; the writer never waits for a reader
  int depth = 1;         ///< samples that a writer keeps per key for repair and, if so, for late joiners; or keep_all
  bool transient_local = false;  ///< a reader that joins late gets what the writer keeps
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

namespace topics {

/// Two seconds at 1 kHz: how far a recorder may fall behind before it loses samples.
inline constexpr int step_depth = 2048;
/// Half a second of local contact models at 1 kHz, which are larger.
inline constexpr int model_depth = 512;

// clang-format off
inline constexpr Topic<ToolState> tool_state{
    "palpate/tool_state", "ToolState", {true, step_depth, false},
    "every haptic step", "haptic", "deform, render",
    "degrees of freedom of one tool as the step consumed them"};
inline constexpr Topic<DeviceState> device_state{
    "palpate/device_state", "DeviceState", {true, 16, false},
    "at the device's rate", "driver", "haptic",
    "degrees of freedom of one tool from a driver elsewhere"};
inline constexpr Topic<ContactState> contact_state{
    "palpate/contact_state", "ContactState", {true, step_depth, false},
    "every haptic step", "haptic", "deform, render",
    "touched nodes with their forces, and the contacts that one tool holds"};
inline constexpr Topic<ContactState> held_contacts{
    "palpate/held_contacts", "ContactState", {true, 1, true},
    "when a haptic node dies", "deform, render", "haptic",
    "last contacts of a haptic node that died, for the one that returns"};
inline constexpr Topic<ForceState> force_state{
    "palpate/force_state", "ForceState", {true, step_depth, false},
    "every haptic step", "haptic", "driver, render",
    "force and torque on one tool after the safety chain"};
inline constexpr Topic<SurfaceState> surface_state{
    "palpate/surface_state", "SurfaceState", {true, 1, false},
    "visual rate and on contact", "deform", "render",
    "deformed visible surface of one body"};
inline constexpr Topic<NodeStatus> node_status{
    "palpate/node_status", "NodeStatus", {true, 1, true},
    "1 Hz and on change", "all", "all",
    "who is there, what it runs and how well it keeps up"};
inline constexpr Topic<ClockProbe> clock_probe{
    "palpate/clock_probe", "ClockProbe", {false, 1, false},
    "8 Hz", "all but haptic", "haptic",
    "asks for the haptic node's clock"};
inline constexpr Topic<ClockAnswer> clock_answer{
    "palpate/clock_answer", "ClockAnswer", {false, 1, false},
    "on each probe", "haptic", "who asked",
    "times of a probe on the haptic node's clock"};
inline constexpr Topic<PictureState> picture_state{
    "palpate/picture_state", "PictureState", {true, 64, false},
    "visual rate", "render", "-",
    "which haptic step a picture shows, and when it was done"};
inline constexpr Topic<HapticKeyframe> haptic_keyframe{
    "palpate/haptic_keyframe", "HapticKeyframe", {true, 4, false},
    "1 Hz", "haptic", "-",
    "state of the haptic loop, from which a replay starts"};
inline constexpr Topic<SceneText> scene{
    "palpate/scene", "SceneText", {true, 1, true},
    "once per run", "haptic", "-",
    "the resolved scene, for recorders that have no scene file"};
inline constexpr Topic<TopologyChange> topology_change{
    "palpate/topology_change", "TopologyChange", {true, keep_all, true},
    "on each cut or tear", "deform", "render",
    "tetrahedra that a body has lost; read all, in order"};
inline constexpr Topic<LocalContactModel> local_contact_model{
    "palpate/local_contact_model", "LocalContactModel", {true, model_depth, false},
    "every deform tick near a tool", "deform", "haptic",
    "moving tissue around one tool: its contacts, near surface and stiffness"};
inline constexpr Topic<DeformStep> deform_step{
    "palpate/deform_step", "DeformStep", {true, step_depth, false},
    "every deform tick", "deform", "-",
    "journal of moving tissue: inputs consumed and hash of the state"};
inline constexpr Topic<DeformKeyframe> deform_keyframe{
    "palpate/deform_keyframe", "DeformKeyframe", {true, 4, false},
    "1 Hz", "deform", "-",
    "state of moving tissue, from which a replay starts"};
inline constexpr Topic<ModalState> modal_state{
    "palpate/modal_state", "ModalState", {true, 16, false},
    "250 Hz", "haptic", "deform, render",
    "modal coordinates of one thin wall and the forces on it"};
inline constexpr Topic<CatheterState> catheter_state{
    "palpate/catheter_state", "CatheterState", {true, 16, false},
    "250 Hz", "haptic", "deform, render",
    "particles of one catheter"};
inline constexpr Topic<TaskRecord> task_record{
    "palpate/task_record", "TaskRecord", {true, 1, true},
    "10 Hz and at the end", "haptic", "render",
    "how the task with one catheter goes"};
// clang-format on

inline constexpr auto all =
    std::tuple{tool_state,  device_state,    contact_state, held_contacts,       force_state,
               surface_state, node_status,   clock_probe, clock_answer, picture_state, haptic_keyframe, scene,
               topology_change, local_contact_model, deform_step, deform_keyframe, modal_state, catheter_state, task_record};

/// Calls f(topic) for every row.
template <class F>
constexpr void for_each(F&& f) {
  std::apply([&](const auto&... topic) { (f(topic), ...); }, all);
}

}  // namespace topics
}  // namespace palpate

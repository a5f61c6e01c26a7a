#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// The messages that cross the bus, as plain values. idl/palpate.idl holds the same fields for DDS; the two are
/// kept in step by a test. Times are CLOCK_MONOTONIC nanoseconds of the host that wrote them, sense_ns of the haptic
/// node.
namespace palpate {

/// One haptic step's input: the degrees of freedom of one tool, as the step consumed them.
struct ToolState {
  std::uint32_t tool = 0;        ///< key: position in the scene's tool list
  std::uint64_t run = 0;         ///< identifies one start of the haptic loop
  std::uint64_t seq = 0;         ///< counts samples of this topic and tool, without gaps
  std::uint64_t step = 0;        ///< haptic step number
  std::int64_t sense_ns = 0;     ///< when the device was read
  std::uint64_t device_seq = 0;  ///< sequence number of the device sample consumed, 0 for a scripted tool
  double yaw = 0, pitch = 0;     ///< [rad] about the trocar
  double depth = 0;              ///< [m] tip beyond the trocar along the shaft
  double roll = 0;               ///< [rad] about the shaft
  double grip = 0;               ///< [rad] jaw opening as the hand asks for it
  double opening = 0;            ///< [rad] between a forceps' jaws, which stop at what they touch; 0 for other tools
  double pedal = 0;              ///< [1] 1 while the tool's pedal is down
  std::uint64_t local_model_run = 0;  ///< run and seq of the LocalContactModel that this step used for this tool;
  std::uint64_t local_model_seq = 0;  ///< 0: none
  std::int64_t publish_ns = 0;        ///< when it was handed to the bus; a writer fills in what is 0
};

/// A driver elsewhere publishes this for a tool whose device is "bus".
struct DeviceState {
  std::uint32_t tool = 0;  ///< key
  std::uint64_t seq = 0;
  std::int64_t sense_ns = 0;
  double yaw = 0, pitch = 0, depth = 0, roll = 0, grip = 0, pedal = 0;  ///< as in ToolState
  std::int64_t publish_ns = 0;  ///< when it was handed to the bus; a writer fills in what is 0
};

/// Linear force on the tissue at one surface node.
struct NodalForce {
  std::uint32_t body = 0;         ///< position in the scene's body list
  std::uint32_t node = 0;         ///< surface node index of that body's archive
  std::array<double, 3> force{};  ///< [N] on the tissue, world frame, before the non-linear correction
};

/// One held contact; enough for a returning haptic node to take it up again.
struct HeldContact {
  std::uint32_t body = 0;
  std::array<std::uint32_t, 3> nodes{};  ///< surface node indices of the touched triangle
  std::array<double, 3> weights{};       ///< barycentric coordinates of the anchor
  std::array<double, 3> offset{};        ///< [m] where it touches, in the frame of the tool's part `sample`
  std::array<double, 3> normal{};        ///< unit, world, from the tool into the tissue
  std::array<double, 3> force{};         ///< [N] on the tissue, world, linear
  std::uint32_t sample = 0;              ///< which part of the tool
  std::uint32_t sticking = 0;            ///< 1 sticks, 0 slides
};

/// Contact information: everything that a deformation node needs of one tool.
struct ContactState {
  std::uint32_t tool = 0;  ///< key
  std::uint64_t run = 0;
  std::uint64_t seq = 0;
  std::uint64_t step = 0;
  std::int64_t sense_ns = 0;
  std::array<double, 3> press{};   ///< unit, world: common direction of this tool's press on the tissue
  std::vector<NodalForce> forces;  ///< f of u = C f, summed over the tool's contacts
  std::vector<HeldContact> contacts;
  std::int64_t publish_ns = 0;  ///< when it was handed to the bus; a writer fills in what is 0
};

/// Force and torque on the tool at its tip, world frame, after correction and safety chain.
struct ForceState {
  std::uint32_t tool = 0;  ///< key
  std::uint64_t run = 0;
  std::uint64_t seq = 0;
  std::uint64_t step = 0;
  std::int64_t sense_ns = 0;
  std::array<double, 3> force{};   ///< [N]
  std::array<double, 3> torque{};  ///< [N m]
  double grip = 0;                 ///< [N m] on the handle, opening the jaws
  std::array<double, 3> trocar{};  ///< [N] of the trocar on the shaft
  double energy = 0;               ///< [J] that all tools together have put into the tissue; negative: taken out
  std::uint32_t flags = 0;         ///< bits of ForceFlag
  std::int64_t publish_ns = 0;     ///< when it was handed to the bus; a writer fills in what is 0
};
/// `stale_model`: the force of moving tissue fades or is gone, because its local contact model comes too late.
/// `passivity_limited`: damped, since the tools would take more energy out of the tissue than they put in.
enum ForceFlag : std::uint32_t {
  force_limited = 1,
  slew_limited = 2,
  fault = 4,
  regularised = 8,
  stale_model = 16,
  passivity_limited = 32
};

/// Visible surface of one body.
struct SurfaceState {
  std::uint32_t body = 0;  ///< key
  std::uint64_t run = 0;   ///< of the haptic loop whose contacts are shown; 0: rest shape
  std::uint64_t seq = 0;
  std::uint64_t step = 0;     ///< newest haptic step included
  std::int64_t sense_ns = 0;  ///< sense time of that step
  std::int64_t publish_ns = 0;
  std::vector<float> position;  ///< [m] x,y,z per surface node, world
  std::vector<float> normal;    ///< unit, x,y,z per surface node, outward
};

/// Who is there. Published on change and once a second.
struct NodeStatus {
  std::string node;  ///< key: role and process, "haptic 4711@host"
  std::string role;  ///< haptic | deform | render | recorder | driver
  std::uint64_t run = 0;
  std::uint64_t seq = 0;
  std::int64_t stamp_ns = 0;
  std::string scene_hash;
  std::string archive_hash;  ///< of all bodies' archives
  std::string version;       ///< software version and code path
  double rate_hz = 0;        ///< measured
  std::uint64_t ticks = 0;
  std::uint64_t missed = 0;
  double latency_p50_us = 0, latency_p99_us = 0;  ///< haptic: step time; deform, render: sense to here
  std::string clock_of;                           ///< node whose clock the next three are about; empty: none known
  std::int64_t clock_offset_ns = 0;               ///< to add to this node's clock for that node's
  std::int64_t clock_uncertainty_ns = 0;          ///< the true offset is within so much of it
  double clock_drift_ppm = 0;                     ///< by which that node's clock runs faster
  std::string text;                               ///< plain sentence for the operator, empty if all is well
};

/// Asks the haptic node for its clock.
struct ClockProbe {
  std::string node;             ///< key: who asks
  std::uint64_t seq = 0;        ///< from 1
  std::int64_t publish_ns = 0;  ///< when it was handed to the bus; a writer fills in what is 0
};

/// The haptic node's answer to a ClockProbe.
struct ClockAnswer {
  std::string node;             ///< key: who asked
  std::string clock_of;         ///< node that answers
  std::string host;             ///< boot of its machine: on the same one all nodes have one clock
  std::uint64_t seq = 0;        ///< of the probe
  std::int64_t probe_ns = 0;    ///< publish_ns of the probe, on the asker's clock
  std::int64_t receive_ns = 0;  ///< when the probe came
  std::int64_t publish_ns = 0;  ///< when it was handed to the bus; a writer fills in what is 0
};

/// A picture is done.
struct PictureState {
  std::string node;             ///< key: the render node
  std::uint64_t run = 0;        ///< of the haptic loop whose state is shown; 0: rest shape
  std::uint64_t seq = 0;        ///< from 1
  std::uint64_t step = 0;       ///< newest haptic step in it
  std::int64_t sense_ns = 0;    ///< sense time of that step
  std::int64_t publish_ns = 0;  ///< when the picture was done
};

/// State of the haptic loop, from which a replay can start.
struct HapticKeyframe {
  std::uint64_t run = 0;
  std::uint64_t seq = 0;
  std::uint64_t step = 0;  ///< state before this step
  double dt = 0;           ///< [s] nominal period
  std::string code_path;   ///< vector width and software version
  std::vector<std::uint8_t> state;
  std::int64_t publish_ns = 0;  ///< when it was handed to the bus; a writer fills in what is 0
};

/// The resolved scene of a running haptic node, for recorders and observers that have no scene file.
struct SceneText {
  std::uint64_t run = 0;
  std::uint64_t seq = 0;
  std::string scene_hash;
  std::string text;             ///< TOML, every default written out
  std::string version;          ///< software version
  std::string code_path;        ///< vector width and libraries of the haptic step
  std::int64_t publish_ns = 0;  ///< when it was handed to the bus; a writer fills in what is 0
};

/// Tetrahedra that a body has lost: one cut or tear, or a part that fell away. Messages are numbered from 1 without
/// gaps, so that a node knows that it has them all; applied in order they give the topology.
struct TopologyChange {
  std::uint32_t body = 0;              ///< key
  std::uint64_t run = 0;               ///< start of the deform node
  std::uint64_t seq = 0;               ///< from 1
  std::uint64_t tick = 0;              ///< of the deform node, after which they are gone
  std::uint32_t cause = 0;             ///< a RemovalCause
  std::vector<std::uint32_t> removed;  ///< tetrahedra of the archive in order of removal, those that followed included
  std::int64_t publish_ns = 0;         ///< when it was handed to the bus; a writer fills in what is 0
};
/// `gone_before`: the first message of a run for each body, with what had gone before it; mostly empty.
enum RemovalCause : std::uint32_t { cut = 0, torn = 1, fell_away = 2, gone_before = 3 };

/// What a node knows a body to have lost, for a deformation node that returns. Each node that follows the changes says
/// so at its start and after each.
struct HeldTopology {
  std::string node;                    ///< key: who remembers
  std::uint32_t body = 0;              ///< key
  std::uint64_t run = 0;               ///< start of the deform node whose changes these are; 0: none was heard of
  std::uint64_t seq = 0;               ///< from 1 in each run
  std::vector<std::uint32_t> removed;  ///< tetrahedra of the archive in order of removal
  std::int64_t publish_ns = 0;         ///< when it was handed to the bus; a writer fills in what is 0
};

/// A place where a tool holds moving tissue, as it was with the tool's pose in the message.
struct LocalContact {
  std::uint32_t body = 0;
  std::uint32_t grasped = 0;          ///< 1: held between jaws, which pull as well as push; 0: rests against the tool
  std::array<double, 3> position{};   ///< [m] world
  std::array<double, 3> normal{};     ///< unit, world, from the tool into the tissue
  std::array<double, 3> force{};      ///< [N] on the tissue, world
  std::array<double, 9> stiffness{};  ///< [N/m] row-major: change of that force per motion of the tool
};

/// A node of moving tissue near a tool.
struct LocalNode {
  std::uint32_t body = 0;
  std::uint32_t node = 0;             ///< surface node index of that body's archive
  std::array<double, 3> position{};   ///< [m] world
  std::array<double, 3> velocity{};   ///< [m/s] world
  std::array<double, 9> stiffness{};  ///< [N/m] row-major, static, all other nodes free: force per displacement
};

/// A surface triangle near a tool; its three nodes as indices into the message's nodes, outward.
struct LocalTriangle {
  std::uint32_t a = 0, b = 0, c = 0;
};

/// Moving tissue around one tool: all that the haptic node needs to render its force until the next message.
struct LocalContactModel {
  std::uint32_t tool = 0;                                    ///< key
  std::uint64_t run = 0;                                     ///< start of the deform node
  std::uint64_t seq = 0;                                     ///< from 1
  std::uint64_t tick = 0;                                    ///< of the deform node
  std::uint64_t tool_run = 0;                                ///< run of the haptic loop that published the pose below
  std::uint64_t tool_step = 0;                               ///< newest haptic step whose tool pose is in here
  std::int64_t sense_ns = 0;                                 ///< sense time of that step
  double yaw = 0, pitch = 0, depth = 0, roll = 0, grip = 0;  ///< that pose, as in ToolState
  std::vector<LocalContact> contacts;
  std::vector<LocalNode> nodes;
  std::vector<LocalTriangle> triangles;
  std::int64_t publish_ns = 0;  ///< when it was handed to the bus; a writer fills in what is 0
};

/// The newest step of one tool that a tick of the deform node consumed.
struct ConsumedStep {
  std::uint32_t tool = 0;
  std::uint64_t run = 0;   ///< start of the haptic loop
  std::uint64_t step = 0;  ///< or tool_left
};
/// In place of a step: the tool's haptic node has ended, and the tool is gone.
inline constexpr std::uint64_t tool_left = ~std::uint64_t{0};

/// Journal of the deform node's moving tissue: what one tick consumed and where it led.
struct DeformStep {
  std::uint64_t run = 0;  ///< start of the deform node
  std::uint64_t seq = 0;  ///< from 1
  std::uint64_t tick = 0;
  std::vector<ConsumedStep> consumed;  ///< at most one per tool
  std::uint64_t hash = 0;              ///< of the state after the tick
  std::int64_t publish_ns = 0;         ///< when it was handed to the bus; a writer fills in what is 0
};

/// State of the deform node's moving tissue, from which a replay can start.
struct DeformKeyframe {
  std::uint64_t run = 0;  ///< start of the deform node
  std::uint64_t seq = 0;
  std::uint64_t tick = 0;  ///< the state is the one before this tick
  double dt = 0;           ///< [s] nominal period of a tick
  std::string code_path;   ///< vector width and software version
  std::vector<std::uint8_t> state;
  std::int64_t publish_ns = 0;  ///< when it was handed to the bus; a writer fills in what is 0
};

/// Force of tools and catheters on a modal body at one surface node.
struct ShellForce {
  std::uint32_t node = 0;        ///< surface node index of that body's archive
  std::array<float, 3> force{};  ///< [N] on the tissue, world frame
};

/// A thin wall that moves by its modes: its displacement is u = Phi coordinates + C f with f the forces, Phi its mode
/// shapes and C its static compliance.
struct ModalState {
  std::uint32_t body = 0;  ///< key
  std::uint64_t run = 0;   ///< start of the haptic loop
  std::uint64_t seq = 0;
  std::uint64_t step = 0;
  std::int64_t sense_ns = 0;
  std::vector<double> coordinates;  ///< [kg^1/2 m] per mode: X - Omega^-2 Phi^T f
  std::vector<ShellForce> forces;   ///< f, at most one per node
  std::int64_t publish_ns = 0;      ///< when it was handed to the bus; a writer fills in what is 0
};

/// Where a catheter is.
struct CatheterState {
  std::uint32_t body = 0;  ///< key
  std::uint64_t run = 0;   ///< start of the haptic loop
  std::uint64_t seq = 0;
  std::uint64_t step = 0;
  std::int64_t sense_ns = 0;
  std::vector<double> position;  ///< [m] x,y,z per particle, world, from tail to tip
  std::int64_t publish_ns = 0;   ///< when it was handed to the bus; a writer fills in what is 0
};

/// How the task of leading a catheter into a duct goes: what a trainer tells the trainee.
struct TaskRecord {
  std::uint32_t body = 0;  ///< key: the catheter
  std::uint64_t run = 0;   ///< start of the haptic loop
  std::uint64_t seq = 0;
  std::uint64_t step = 0;
  std::int64_t sense_ns = 0;
  double inserted = 0;              ///< [m] of the catheter inside the duct now
  double deepest = 0;               ///< [m] most that was inside so far
  double inserting_s = 0;           ///< [s] from the first entry to the deepest place
  double largest_force = 0;         ///< [N] on any tool so far
  std::uint64_t wall_contacts = 0;  ///< touches of the wall that have begun
  std::uint64_t grasps = 0;         ///< how often jaws took the catheter
  std::uint64_t drops = 0;          ///< how often it slipped out of the jaws
  double held_s = 0;                ///< [s] that jaws have held it
  std::int64_t publish_ns = 0;      ///< when it was handed to the bus; a writer fills in what is 0
};

}  // namespace palpate

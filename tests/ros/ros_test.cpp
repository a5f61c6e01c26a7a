#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iterator>
#include <map>

#include "common/bus/dds_bus.hpp"
#include "common/realtime/clock.hpp"
#include "common/tool/kinematics.hpp"
#include "tests/bus/domain.hpp"
#include "tests/loopback/loopback_scene.hpp"
#include "tests/ros/twin.hpp"
#include "tools/shared/child_process.hpp"
#include "twin.h"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using testing::LoopbackScene;
using testing::own_domain;
using testing::program;
using testing::RosTwin;
using testing::run_command;

/// ROS's domain lies beside the scene's.
int ros_domain() {
  return own_domain() + 100;
}

std::vector<std::string> node(const std::string& name, const LoopbackScene& scene, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{program(name), scene.scene(), "--domain", std::to_string(own_domain())};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::vector<std::string> bridge(const LoopbackScene& scene) {
  return node("ros_bridge", scene, {"--ros-domain", std::to_string(ros_domain()), "--rate", "100"});
}

void precompute(const LoopbackScene& scene) {
  std::string said;
  ASSERT_EQ(run_command(program("palpate") + " precompute " + scene.scene(), &said), 0) << said;
}

/// A stamp of ROS on CLOCK_MONOTONIC [ns].
std::int64_t mono(const std_msgs_msg_dds__Header_& header) {
  return header.stamp.sec * kNsPerS + header.stamp.nanosec - (wall_ns() - now_ns());
}

/// What was sensed nearest to when ROS says, as a late tick may be close behind another; null if nothing was within
/// 50 us of it.
template <class M>
const M* sensed_at(const std::map<std::int64_t, M>& all, std::int64_t at) {
  auto nearest = all.lower_bound(at);
  if (nearest == all.end() || (nearest != all.begin() && at - std::prev(nearest)->first < nearest->first - at)) {
    if (nearest == all.begin()) return nullptr;
    --nearest;
  }
  return std::abs(nearest->first - at) < 50'000 ? &nearest->second : nullptr;
}

Eigen::Vector3d vec(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}

Eigen::Isometry3d tip_of(const ToolState& s) {  // of the loopback scene's tool
  const Trocar trocar = make_trocar({0, 0, 0.2}, -Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY());
  return tip_pose(trocar, {s.yaw, s.pitch, s.depth, s.roll, s.grip});
}

struct Pose {
  std::string frame;
  Eigen::Vector3d position;
  Eigen::Quaterniond turn;
};
struct Force {
  std::string frame;
  Eigen::Vector3d force, torque;
};
struct Surface {
  std::string frame, name;
  int type = 0;
  std::vector<Eigen::Vector3f> corners;
};

Surface surface(const visualization_msgs_msg_dds__Marker_& marker) {
  Surface s{marker.header.frame_id, marker.ns, marker.type, {}};
  for (std::uint32_t i = 0; i < marker.points._length; ++i)
    s.corners.push_back(vec(marker.points._buffer[i].v).cast<float>());
  return s;
}

Pose pose(const char* frame, const geometry_msgs_msg_dds__Triple& at, const double (&q)[4]) {
  return {frame, vec(at.v), Eigen::Quaterniond(q[3], q[0], q[1], q[2])};
}

/// All of one run, by the time at which the tool was read: what ROS has and what the project's bus has.
class Ears {
 public:
  Ears() : twin(ros_domain()), bus_(make_dds_bus({.domain = own_domain()})) {
    tool_ = bus_->reader(topics::tool_state, Keep::all);
    force_ = bus_->reader(topics::force_state, Keep::all);
    surface_ = bus_->reader(topics::surface_state, Keep::all);
    hear<geometry_msgs_msg_dds__PoseStamped_>(
        "rt/palpate/probe/pose", geometry_msgs_msg_dds__PoseStamped__desc,
        [this](const auto& m) { poses[mono(m.header)] = pose(m.header.frame_id, m.position, m.orientation); });
    hear<geometry_msgs_msg_dds__WrenchStamped_>(
        "rt/palpate/probe/wrench", geometry_msgs_msg_dds__WrenchStamped__desc, [this](const auto& m) {
          wrenches[mono(m.header)] = {m.header.frame_id, vec(m.force.v), vec(m.torque.v)};
        });
    hear<tf2_msgs_msg_dds__TFMessage_>("rt/tf", tf2_msgs_msg_dds__TFMessage__desc, [this](const auto& m) {
      for (std::uint32_t i = 0; i < m.transforms._length; ++i) {
        const auto& t = m.transforms._buffer[i];
        tips[mono(t.header)] = pose(t.child_frame_id, t.translation, t.rotation);
      }
    });
    hear<sensor_msgs_msg_dds__JointState_>("rt/palpate/probe/joint_states", sensor_msgs_msg_dds__JointState__desc,
                                           [this](const auto& m) {
                                             auto& all = joints[mono(m.header)];
                                             for (std::uint32_t i = 0; i < m.name._length; ++i)
                                               all[m.name._buffer[i]] = m.position._buffer[i];
                                           });
    hear<visualization_msgs_msg_dds__Marker_>("rt/palpate/block/surface", visualization_msgs_msg_dds__Marker__desc,
                                              [this](const auto& m) { surfaces[mono(m.header)] = surface(m); });
  }

  template <class Until>
  bool listen(std::chrono::milliseconds limit, Until until) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (std::chrono::steady_clock::now() < end) {
      bus_->wait(2ms);
      while (auto m = tool_->take()) tool[m->sense_ns] = *m;
      while (auto m = force_->take()) force[m->sense_ns] = *m;
      while (auto m = surface_->take()) shape[m->sense_ns] = *m;
      twin.take();
      if (until()) return true;
    }
    return false;
  }

  RosTwin twin;
  std::map<std::int64_t, ToolState> tool;
  std::map<std::int64_t, ForceState> force;
  std::map<std::int64_t, SurfaceState> shape;
  std::map<std::int64_t, Pose> poses, tips;
  std::map<std::int64_t, Force> wrenches;
  std::map<std::int64_t, std::map<std::string, double>> joints;
  std::map<std::int64_t, Surface> surfaces;

 private:
  template <class M, class Receive>
  void hear(const std::string& topic, const dds_topic_descriptor_t& type, Receive receive) {
    twin.subscribe(topic, type, [receive](const void* sample) { receive(*static_cast<const M*>(sample)); });
  }

  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Reader<ToolState>> tool_;
  std::unique_ptr<Reader<ForceState>> force_;
  std::unique_ptr<Reader<SurfaceState>> surface_;
};

void expect_the_tools_pose(const Ears& ears, const std::map<std::int64_t, Pose>& poses, const std::string& frame) {
  std::size_t found = 0;
  for (const auto& [at, pose] : poses) {
    const ToolState* state = sensed_at(ears.tool, at);
    if (!state) continue;
    ++found;
    const Eigen::Isometry3d tip = tip_of(*state);
    EXPECT_EQ(pose.frame, frame);
    EXPECT_LT((pose.position - tip.translation()).norm(), 1e-12);
    EXPECT_LT((pose.turn.toRotationMatrix() - tip.linear()).norm(), 1e-9);
  }
  EXPECT_GT(found, 0.9 * static_cast<double>(poses.size())) << "stamps are the times at which the tool was read";
}

/// [Hz] of stamps between the first and the last.
template <class M>
double rate_of(const std::map<std::int64_t, M>& told) {
  return 1e9 * static_cast<double>(told.size() - 1) / static_cast<double>(told.rbegin()->first - told.begin()->first);
}

TEST(RosBridge, ATwinOfRosSeesPosesJointsWrenchesAndSurfacesOfARunningScene) {
  const LoopbackScene scene("ros");
  precompute(scene);
  Ears ears;
  ChildProcess deform("deform_node", node("deform_node", scene));
  ChildProcess ros("ros_bridge", bridge(scene));
  ASSERT_TRUE(ears.listen(20s, [&] { return ears.twin.writers().contains("rt/palpate/block/surface"); }));
  ChildProcess haptic("haptic_node", node("haptic_node", scene, {"--seconds", "2.3"}));
  ears.listen(30s, [&] { return !haptic.running(); });

  ASSERT_GT(ears.poses.size(), 50u);
  expect_the_tools_pose(ears, ears.poses, "world");
  expect_the_tools_pose(ears, ears.tips, "probe_tip");
  EXPECT_NEAR(rate_of(ears.poses), 100, 15);
  EXPECT_NEAR(rate_of(ears.wrenches), 100, 15);

  for (const auto& [at, joints] : ears.joints)
    if (const ToolState* state = sensed_at(ears.tool, at); state) {
      const std::map<std::string, double> expected{{"yaw", state->yaw},
                                                   {"pitch", state->pitch},
                                                   {"depth", state->depth},
                                                   {"roll", state->roll},
                                                   {"grip", state->grip}};
      EXPECT_EQ(joints, expected);
    }

  double largest = 0;
  for (const auto& [at, wrench] : ears.wrenches) {
    const ForceState* force = sensed_at(ears.force, at);
    const ToolState* state = sensed_at(ears.tool, at);
    if (!force || !state) continue;
    EXPECT_EQ(wrench.frame, "probe_tip");
    const Eigen::Matrix3d to_world = tip_of(*state).linear();
    const Eigen::Vector3d in_world = to_world * wrench.force, about_tip = to_world * wrench.torque;
    // Of the newest pose: a tick apart where a force comes a step after its pose.
    EXPECT_LT((in_world - Eigen::Vector3d(force->force.data())).norm(), 2e-3 * wrench.force.norm() + 1e-12);
    EXPECT_LT((about_tip - Eigen::Vector3d(force->torque.data())).norm(), 2e-3 * wrench.torque.norm() + 1e-12);
    largest = std::max(largest, -wrench.force.z());
  }
  EXPECT_GT(largest, 0.1) << "pushes the tool back along its shaft";

  std::size_t same = 0;
  for (const auto& [at, surface] : ears.surfaces) {
    EXPECT_EQ(surface.frame, "world");
    EXPECT_EQ(surface.name, "block");
    EXPECT_EQ(surface.type, 11) << "TRIANGLE_LIST";
    ASSERT_EQ(surface.corners.size() % 3, 0u);
    const SurfaceState* shape = sensed_at(ears.shape, at);
    if (!shape || shape->run == 0) continue;
    std::set<std::array<float, 3>> nodes;
    for (std::size_t i = 0; i < shape->position.size(); i += 3)
      nodes.insert({shape->position[i], shape->position[i + 1], shape->position[i + 2]});
    same += std::ranges::all_of(surface.corners, [&](const Eigen::Vector3f& c) {
      return nodes.contains({c.x(), c.y(), c.z()});
    });
  }
  EXPECT_GT(same, 20u) << "of " << ears.surfaces.size();
}

TEST(RosBridge, ItIsANodeOfRosToThoseWhoComeLater) {
  const LoopbackScene scene("ros_node");
  precompute(scene);
  ChildProcess ros("ros_bridge", bridge(scene));
  std::this_thread::sleep_for(1s);
  RosTwin twin(ros_domain());
  std::string name, participant;
  std::set<std::string> told;
  twin.subscribe(
      "ros_discovery_info", rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc,
      [&](const void* sample) {
        const auto& info = *static_cast<const rmw_dds_common_msg_dds__ParticipantEntitiesInfo_*>(sample);
        participant.assign(reinterpret_cast<const char*>(info.gid.data), 16);
        const auto& node = info.node_entities_info_seq._buffer[0];
        name = std::string(node.node_namespace) + node.node_name;
        for (std::uint32_t i = 0; i < node.writer_gid_seq._length; ++i)
          told.emplace(reinterpret_cast<const char*>(node.writer_gid_seq._buffer[i].data), 16);
      },
      true);
  for (int tries = 0; tries < 200 && name.empty(); ++tries) {
    twin.take();
    std::this_thread::sleep_for(50ms);
  }
  EXPECT_EQ(name, "/palpate");
  EXPECT_EQ(twin.words_of(participant), "enclave=/;");
  const auto writers = twin.writers();
  for (const auto& [topic, type] :
       std::map<std::string, std::string>{{"rt/palpate/probe/pose", "geometry_msgs::msg::dds_::PoseStamped_"},
                                          {"rt/palpate/probe/wrench", "geometry_msgs::msg::dds_::WrenchStamped_"},
                                          {"rt/palpate/probe/joint_states", "sensor_msgs::msg::dds_::JointState_"},
                                          {"rt/palpate/block/surface", "visualization_msgs::msg::dds_::Marker_"},
                                          {"rt/tf", "tf2_msgs::msg::dds_::TFMessage_"}}) {
    ASSERT_TRUE(writers.contains(topic)) << topic;
    const RosTwin::Endpoint& writer = writers.at(topic);
    EXPECT_EQ(writer.type, type);
    EXPECT_TRUE(writer.reliable && writer.is_volatile && writer.plain_cdr) << topic;
    EXPECT_EQ(writer.participant, participant);
    EXPECT_TRUE(told.contains(writer.guid)) << topic << " is not told of the node";
  }
  for (const auto& [topic, writer] : writers)
    EXPECT_FALSE(topic.starts_with("palpate/")) << "the scene's own topics stay in the scene's domain";
}

/// A commander of ROS: its JointState at 100 Hz.
class Commander {
 public:
  explicit Commander(RosTwin& twin)
      : writer_(twin.publisher("rt/palpate/probe/command", sensor_msgs_msg_dds__JointState__desc)) {}

  void command(std::vector<const char*> names, std::vector<double> positions) {
    sensor_msgs_msg_dds__JointState_ state{};
    state.header.frame_id = const_cast<char*>("");
    state.name._length = state.name._maximum = static_cast<std::uint32_t>(names.size());
    state.name._buffer = const_cast<char**>(names.data());
    state.position._length = state.position._maximum = static_cast<std::uint32_t>(positions.size());
    state.position._buffer = positions.data();
    dds_write(writer_, &state);
  }

 private:
  dds_entity_t writer_;
};

TEST(RosBridge, ACommandOfRosMovesATool) {
  const LoopbackScene scene("ros_command");
  scene.replace("device = \"scripted\"\ntrajectory = \"motion.csv\"", "device = \"bus\"\nlease = 1.0");
  precompute(scene);
  Ears ears;
  Commander commander(ears.twin);
  ChildProcess ros("ros_bridge", bridge(scene));
  ChildProcess haptic("haptic_node", node("haptic_node", scene));
  const auto tool_stands_at = [&](double yaw, double depth) {
    return [&ears, yaw, depth] {
      return !ears.poses.empty() && !ears.tool.empty() &&
             (ears.poses.rbegin()->second.position - tip_of({.yaw = yaw, .depth = depth}).translation()).norm() < 1e-6;
    };
  };
  const auto goes_to = [&](double yaw, double depth, auto command) {
    return ears.listen(20s, [&] {
      command();
      return tool_stands_at(yaw, depth)();
    });
  };
  EXPECT_TRUE(goes_to(0.05, 0.15, [&] { commander.command({"depth", "yaw"}, {0.15, 0.05}); }));
  EXPECT_TRUE(goes_to(0.05, 0.17, [&] { commander.command({"depth"}, {0.17}); })) << "others stay as they are";
  for (int i = 0; i < 100; ++i) {
    commander.command({"depth", "elbow"}, {0.1, 0.0});
    commander.command({"depth"}, {std::nan("")});
    commander.command({"depth", "yaw"}, {0.1});
    ears.listen(5ms, [] { return false; });
  }
  EXPECT_TRUE(tool_stands_at(0.05, 0.17)()) << "a command with a wrong joint, number or length moves nothing";
  EXPECT_TRUE(goes_to(0, 0.16, [&] { commander.command({"depth", "yaw"}, {0.16, 0}); }));
}

TEST(RosBridge, BesideASceneWithKeysRosNeedsADomainOfItsOwn) {
  const LoopbackScene scene("ros_keys");
  precompute(scene);
  const std::string keys = scene.folder() / "keys";
  std::string said;
  ASSERT_EQ(run_command(program("palpate") + " keys " + keys, &said), 0) << said;
  const std::string command =
      fmt::format("{} {} --domain {} --keys {} --seconds 1", program("ros_bridge"), scene.scene(), own_domain(), keys);
  EXPECT_EQ(run_command(command, &said), 1);
  EXPECT_NE(said.find("asks for keys: ROS needs another, --ros-domain"), std::string::npos) << said;
  EXPECT_EQ(run_command(fmt::format("{} --ros-domain {}", command, ros_domain()), &said), 0) << said;
}

TEST(RosBridge, TwoNamesThatAreOneInRosAreRefusedInWords) {
  const LoopbackScene scene("ros_names");
  scene.replace("[render]",
                "[[tool]]\nname = \"a-b\"\npivot = [0.0, 0.0, 0.3]\ndevice = \"bus\"\n\n"
                "[[tool]]\nname = \"a_b\"\npivot = [0.0, 0.0, 0.3]\ndevice = \"bus\"\n\n[render]");
  precompute(scene);
  std::string said;
  EXPECT_EQ(run_command(program("ros_bridge") + " " + scene.scene(), &said), 1);
  EXPECT_NE(said.find("'a-b' and 'a_b' are one name in ROS"), std::string::npos) << said;
}

}  // namespace
}  // namespace palpate

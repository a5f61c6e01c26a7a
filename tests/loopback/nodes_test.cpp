#include <gtest/gtest.h>

#include <csignal>
#include <map>
#include <set>

#include "common/bus/dds_bus.hpp"
#include "common/fem/direct.hpp"
#include "common/realtime/clock.hpp"
#include "common/scene/find_archive.hpp"
#include "common/scene/scene.hpp"
#include "common/tool/kinematics.hpp"
#include "tests/bus/domain.hpp"
#include "tests/loopback/loopback_scene.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using testing::kLinear;
using testing::LoopbackScene;
using testing::own_domain;
using testing::program;
using testing::run_command;

std::vector<std::string> node(const std::string& name, const LoopbackScene& scene, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{program(name), scene.scene(), "--domain", std::to_string(own_domain())};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// Everything that crosses the bus, by step.
struct Heard {
  std::map<std::uint64_t, ToolState> tools;
  std::map<std::uint64_t, ContactState> contacts;
  std::map<std::uint64_t, SurfaceState> surfaces;
  std::map<std::uint64_t, ForceState> forces;
};

class Ear {
 public:
  Ear() : bus_(make_dds_bus({.domain = own_domain()})) {
    tool_ = bus_->reader(topics::tool_state, Keep::all);
    contact_ = bus_->reader(topics::contact_state, Keep::all);
    surface_ = bus_->reader(topics::surface_state, Keep::all);
    force_ = bus_->reader(topics::force_state, Keep::all);
  }
  template <class Until>
  bool listen(Heard& heard, std::chrono::milliseconds limit, Until until) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (std::chrono::steady_clock::now() < end) {
      bus_->wait(10ms);
      while (auto m = tool_->take()) heard.tools[m->step] = *m;
      while (auto m = contact_->take()) heard.contacts[m->step] = *m;
      while (auto m = surface_->take()) heard.surfaces[m->step] = *m;
      while (auto m = force_->take()) heard.forces[m->step] = *m;
      if (until()) return true;
    }
    return false;
  }

 private:
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Reader<ToolState>> tool_;
  std::unique_ptr<Reader<ContactState>> contact_;
  std::unique_ptr<Reader<SurfaceState>> surface_;
  std::unique_ptr<Reader<ForceState>> force_;
};

Eigen::Vector3d vec(const std::array<double, 3>& a) {
  return {a[0], a[1], a[2]};
}

/// The contacts of one step as bilateral conditions for the direct solver: sticking anchors lie where the tool's pose
/// puts them, sliding ones on the tip's surface along their normal. Sliding friction is left to the caller.
std::vector<Constraint> conditions(const Scene& scene, const Archive& archive, const ToolState& tool,
                                   const ContactState& contacts) {
  const Tool& t = scene.tools[0];
  const Eigen::Isometry3d tip =
      tip_pose(make_trocar(t.pivot, t.axis, t.up), {tool.yaw, tool.pitch, tool.depth, tool.roll, tool.grip});
  std::vector<Constraint> all;
  for (const HeldContact& c : contacts.contacts) {
    Eigen::Vector3d rest = Eigen::Vector3d::Zero();
    for (int v = 0; v < 3; ++v) rest += c.weights[v] * archive.surface.position[c.nodes[v]];
    const Eigen::Vector3d target = tip * vec(c.offset);
    for (int axis = 0; axis < 3; ++axis) {
      Constraint k{.terms = {}, .value = target[axis] - rest[axis]};
      for (int v = 0; v < 3; ++v)
        if (c.weights[v] != 0) k.terms.push_back({archive.surface.node_number[c.nodes[v]], axis, c.weights[v]});
      all.push_back(k);
    }
  }
  return all;
}

class NodesTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    // Held points of linear elements, which the direct solver can take for its conditions.
    scene_ = new LoopbackScene("nodes", kLinear);
    scene_->replace("[render]", "[contact]\nrule = \"barycentric\"\n\n[render]");
    std::string said;
    ASSERT_EQ(run_command(program("palpate") + " precompute " + scene_->scene(), &said), 0) << said;
  }
  static void TearDownTestSuite() { delete scene_; }
  static LoopbackScene* scene_;
};
LoopbackScene* NodesTest::scene_ = nullptr;

TEST_F(NodesTest, TheSurfaceThatARenderNodeReceivesIsTheDirectSolversForTheSameContact) {
  const Scene scene = load_scene(scene_->scene());
  const Archive archive = find_archive(scene, scene.bodies[0], ArchivePart::surface);
  const SolidSpec& block = *as<SolidSpec>(scene.bodies[0]);
  const StaticProblem problem = make_static_problem(block, load_tet_mesh(block.mesh, block.scale));
  Ear ear;
  Heard heard;
  ChildProcess deform("deform_node", node("deform_node", *scene_));
  ASSERT_TRUE(ear.listen(heard, 20s, [&] { return !heard.surfaces.empty(); }));
  ChildProcess render("render_node", node("render_node", *scene_, {"--seconds", "4"}));
  ChildProcess haptic("haptic_node", node("haptic_node", *scene_, {"--seconds", "2.3"}));
  ear.listen(heard, 20s, [&] { return !haptic.running(); });
  EXPECT_EQ(haptic.status(), 0);
  ASSERT_GT(heard.contacts.size(), 300u);

  std::vector<std::uint64_t> comparable;
  for (const auto& [step, surface] : heard.surfaces) {
    const auto contacts = heard.contacts.find(step);
    const auto force = heard.forces.find(step);
    if (contacts == heard.contacts.end() || force == heard.forces.end() || !heard.tools.contains(step)) continue;
    const auto& points = contacts->second.contacts;
    const bool all_stick = std::all_of(points.begin(), points.end(), [](const auto& c) { return c.sticking; });
    if (!points.empty() && all_stick && !(force->second.flags & regularised)) comparable.push_back(step);
  }
  ASSERT_GE(comparable.size(), 4u);

  const std::size_t stride = (comparable.size() + 11) / 12;
  double largest = 0;
  for (std::size_t i = 0; i < comparable.size(); i += stride) {
    const std::uint64_t step = comparable[i];
    const SurfaceState& surface = heard.surfaces.at(step);
    const ToolState& tool = heard.tools.at(step);
    const ContactState& contacts = heard.contacts.at(step);
    const StaticSolution direct = solve_direct(problem, conditions(scene, archive, tool, contacts));
    double error = 0, size = 0;
    for (int n = 0; n < archive.surface.size(); ++n) {
      const Eigen::Vector3f shown(surface.position[3 * n], surface.position[3 * n + 1], surface.position[3 * n + 2]);
      const Eigen::Vector3d expected =
          archive.surface.position[n] + direct.displacement[archive.surface.node_number[n]];
      error = std::max(error, (shown.cast<double>() - expected).norm());
      size = std::max(size, direct.displacement[archive.surface.node_number[n]].norm());
    }
    EXPECT_LT(error, 1e-5 * size + 2e-8) << "step " << step << ", largest displacement " << size << " m";
    Eigen::Vector3d on_tissue = Eigen::Vector3d::Zero(), expected = Eigen::Vector3d::Zero();
    for (const NodalForce& f : contacts.forces) on_tissue += vec(f.force);
    std::set<int> held;
    for (const HeldContact& c : contacts.contacts)
      for (int v = 0; v < 3; ++v)
        if (c.weights[v] != 0) held.insert(archive.surface.node_number[c.nodes[v]]);
    for (int n : held) expected += direct.force[n];
    EXPECT_LT((on_tissue - expected).norm(), 1e-6 * expected.norm()) << "step " << step;
    largest = std::max(largest, size);
  }
  EXPECT_GT(largest, 2e-3);
}

TEST_F(NodesTest, AnyNodeMayStartFirstDieAndComeBack) {
  Ear ear;
  Heard heard;
  ChildProcess deform("deform_node", node("deform_node", *scene_));
  std::this_thread::sleep_for(500ms);
  {
    ChildProcess haptic("haptic_node", node("haptic_node", *scene_, {"--seconds", "10"}));
    ASSERT_TRUE(
        ear.listen(heard, 20s, [&] { return !heard.surfaces.empty() && heard.surfaces.rbegin()->second.run != 0; }));
    const std::uint64_t first_step = heard.surfaces.rbegin()->first;
    kill(deform.pid(), SIGKILL);
    ASSERT_TRUE(deform.wait(5s));
    const std::uint64_t at_death = heard.tools.rbegin()->first;
    ASSERT_TRUE(ear.listen(heard, 5s, [&] { return heard.tools.rbegin()->first > at_death + 300; }))
        << "the haptic loop goes on alone";
    EXPECT_GE(heard.surfaces.rbegin()->first, first_step);
    heard.surfaces.clear();
    ChildProcess again("deform_node", node("deform_node", *scene_));
    EXPECT_TRUE(ear.listen(heard, 10s, [&] { return !heard.surfaces.empty(); }))
        << "a deformation node that comes back serves the same run";
    kill(haptic.pid(), SIGKILL);
    ASSERT_TRUE(haptic.wait(5s));
    heard = {};
    ChildProcess second("haptic_node", node("haptic_node", *scene_, {"--seconds", "2.2"}));
    EXPECT_TRUE(ear.listen(heard, 20s, [&] {
      return !heard.surfaces.empty() && !heard.tools.empty() &&
             heard.surfaces.rbegin()->second.run == heard.tools.rbegin()->second.run;
    })) << "a haptic node that comes back is followed";
  }
}

TEST_F(NodesTest, AnotherScenesContactsAreRefusedInWords) {
  LoopbackScene other("other", kLinear, 9000);
  other.write("motion.csv", "time,yaw,pitch,depth,roll,grip\n0,0,0,0.17,0,0\n1,0,0,0.198,0,0\n300,0,0,0.198,0,0\n");
  std::string said;
  ASSERT_EQ(run_command(program("palpate") + " precompute " + other.scene(), &said), 0) << said;
  Ear ear;
  Heard heard;
  ChildProcess haptic("haptic_node", node("haptic_node", other));
  ASSERT_TRUE(ear.listen(heard, 20s, [&] { return !heard.tools.empty(); }));
  const std::string command =
      fmt::format("{} {} --domain {} --seconds 3", program("deform_node"), scene_->scene(), own_domain());
  EXPECT_EQ(run_command(command, &said), 0);
  EXPECT_NE(said.find("refusing haptic"), std::string::npos) << said;
  ear.listen(heard, 200ms, [] { return false; });
  for (const auto& [step, surface] : heard.surfaces) EXPECT_EQ(surface.run, 0u);
}

}  // namespace
}  // namespace palpate

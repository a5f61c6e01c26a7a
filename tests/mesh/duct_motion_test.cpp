#include <limits>

#include "common/geometry/triangle.hpp"
#include "common/mesh/shell_file.hpp"
#include "common/mesh/shell_quality.hpp"
#include "common/tool/forceps.hpp"
#include "common/tool/trajectory.hpp"
#include "tests/mesh/mesh_test_helpers.hpp"
#include "tools/generate/duct.hpp"
#include "tools/generate/duct_motions.hpp"

// The duct's example scenes by geometry alone: where tools, duct and catheter meet when nothing gives way.
namespace palpate {
namespace {

using Eigen::Vector3d;

const std::string kScenes = PALPATE_SOURCE "/scenes/";

class ScriptedForceps {
 public:
  explicit ScriptedForceps(const Tool& tool)
      : tool_(tool),
        trocar_(make_trocar(tool.pivot, tool.axis, tool.up)),
        trajectory_(load_trajectory(std::get<ScriptedDeviceSpec>(tool.device).trajectory)) {}

  double duration() const { return trajectory_.duration(); }
  double grip(double time) const { return trajectory_.at(time).grip; }
  Eigen::Isometry3d pose(double time) const { return tip_pose(trocar_, trajectory_.at(time)); }
  std::vector<std::pair<Segment, double>> parts(double time) const {
    const TurningJaws& jaws = std::get<ForcepsSpec>(tool_.end).jaws;
    const ForcepsShape shape{tool_.shaft_radius, tool_.shaft_length, jaws.length, jaws.radius};
    std::vector<std::pair<Segment, double>> parts;
    for (const ToolPart& part : forceps_parts(shape, grip(time)))
      parts.emplace_back(part.axis(pose(time)), part.radius);
    return parts;
  }

  /// Least distance [m] between its surface and the surface of the wall at rest; negative in the wall,
  /// whatever the side.
  double gap(double time, const ShellMesh& mesh, double thickness) const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [segment, radius] : parts(time))
      for (double s = 0; s <= 1; s += 0.0005 / segment.length()) {
        const Vector3d p = segment.at(s);
        if (p.norm() > 0.1) break;
        for (const auto& [a, b, c] : mesh.triangles) {
          if ((mesh.nodes[a] - p).norm() > 0.02) continue;
          const double d = std::sqrt(closest_point(p, {mesh.nodes[a], mesh.nodes[b], mesh.nodes[c]}).squared_distance);
          least = std::min(least, d - radius - 0.5 * thickness);
        }
      }
    return least;
  }

 private:
  Tool tool_;
  Trocar trocar_;
  Trajectory trajectory_;
};

class DuctScene : public ::testing::Test {
 protected:
  void load(const char* name) {
    scene = load_scene(kScenes + name);
    const auto& wall = std::get<ModalShellSpec>(scene.bodies[0]);
    duct = load_shell_mesh(wall.mesh, wall.scale);
    thickness = wall.shell.thickness;
    for (const Tool& tool : scene.tools) tools.emplace_back(tool);
  }
  /// Least gap of a tool between two times.
  double gap(int tool, double begin, double end) const {
    double least = std::numeric_limits<double>::infinity();
    for (double t = begin; t <= end; t += 0.05) least = std::min(least, tools[tool].gap(t, duct, thickness));
    return least;
  }

  Scene scene;
  ShellMesh duct;
  double thickness = 0;
  std::vector<ScriptedForceps> tools;
};

TEST_F(DuctScene, MeshAndMotionsAreThoseOfTheGenerator) {
  const TestFolder folder;
  write_shell_mesh(make_duct(), folder.path("duct.msh"));
  EXPECT_EQ(bytes_of(folder.path("duct.msh")), bytes_of(kScenes + "meshes/duct.msh"));
  for (const char* name : {"duct_poke.toml", "catheter_insertion.toml"}) {
    const Scene scene = load_scene(kScenes + name);
    for (const Tool& tool : scene.tools) {
      const auto& file = std::get<ScriptedDeviceSpec>(tool.device).trajectory;
      EXPECT_EQ(duct_motion(scene, tool), bytes_of(file)) << file;
    }
  }
}

TEST_F(DuctScene, TheDuctIsATubeNineMillimetresWideInside) {
  load("catheter_insertion.toml");
  EXPECT_EQ(duct.nodes.size(), 500u);
  EXPECT_EQ(boundary_loops(duct.triangles).size(), 2u);
  for (const TubeSection& section : tube_sections(duct)) {
    const double width = 2 * (section.radius - 0.5 * thickness);
    EXPECT_GT(width, 0.008);
    EXPECT_LT(width, 0.010);
  }
}

TEST_F(DuctScene, TheFeedingForcepsKeepsClearOfTheDuct) {
  load("catheter_insertion.toml");
  EXPECT_GT(gap(0, 0, tools[0].duration()), 0.005);
}

TEST_F(DuctScene, TheFeedingForcepsHasTheCatheterBetweenItsJawsAndClosesOnIt) {
  load("catheter_insertion.toml");
  const Catheter& catheter = std::get<CatheterSpec>(scene.bodies[1]).catheter;
  const double touching = catheter.radius + std::get<ForcepsSpec>(scene.tools[0].end).jaws.radius;
  double fed = 0, before = 0;
  bool held = false;
  for (double t = 0; t <= tools[0].duration(); t += 0.01) {
    const Eigen::Isometry3d tip = tools[0].pose(t).inverse();
    const Vector3d a = tip * catheter.tail, along = (tip * catheter.tip - a).normalized();
    const Vector3d middle = a - along * a.x() / along.x();  // where the catheter passes the jaws' plane
    const double opening = tools[0].grip(t), here = (tools[0].pose(t) * middle).x();
    const double to_jaw = middle.z() * std::sin(0.5 * opening);
    if (opening < 0.35) {  // closed on it
      EXPECT_NEAR(middle.y(), 0, 2e-4);
      EXPECT_NEAR(middle.z(), 0.6 * std::get<ForcepsSpec>(scene.tools[0].end).jaws.length, 2e-4);
      EXPECT_LT(to_jaw, touching);
      if (held) fed += before - here;
    } else if (opening > 0.85 && middle.z() > 0 && middle.z() < std::get<ForcepsSpec>(scene.tools[0].end).jaws.length) {
      EXPECT_GT(to_jaw - std::abs(middle.y()),
                middle.z() > 0.6 * std::get<ForcepsSpec>(scene.tools[0].end).jaws.length - 1e-4 ? touching : 0);
    }
    held = opening < 0.35;
    before = here;
  }
  EXPECT_NEAR(fed, 0.038, 5e-4);
  EXPECT_GT(tools[0].duration(), 24);
  EXPECT_LT(tools[0].duration(), 31);
}

TEST_F(DuctScene, TheOtherForcepsPushesTheDuctLightlyWithBothJaws) {
  load("catheter_insertion.toml");
  EXPECT_GT(gap(1, 0, 2.6), 2e-4);
  const auto parts = tools[1].parts(10);
  for (int jaw : {forceps_jaw_a, forceps_jaw_b}) {
    double least = 1;
    for (double s = 0; s <= 1; s += 0.02)
      for (const auto& [a, b, c] : duct.triangles)
        least = std::min(
            least,
            std::sqrt(
                closest_point(parts[jaw].first.at(s), {duct.nodes[a], duct.nodes[b], duct.nodes[c]}).squared_distance));
    EXPECT_NEAR(least - parts[jaw].second - 0.5 * thickness, -0.0015, 0.0004);
  }
  EXPECT_GT(gap(1, tools[1].duration() - 0.2, tools[1].duration()), 0.005);
}

TEST_F(DuctScene, TheTwoForcepsDoNotMeet) {
  load("catheter_insertion.toml");
  for (double t = 0; t <= tools[0].duration(); t += 0.1)
    for (const auto& [one, radius] : tools[0].parts(t))
      for (const auto& [other, other_radius] : tools[1].parts(t))
        for (double s = 0; s <= 1; s += 0.02)
          ASSERT_GT((nearest_point(other, one.at(s)) - one.at(s)).norm(), radius + other_radius + 0.003) << t;
}

TEST_F(DuctScene, ThePokingForcepsMeetsTheDuctOnlyWhereItShall) {
  load("duct_poke.toml");
  EXPECT_GT(gap(0, 0, 1.4), 2e-4);  // until it pokes
  EXPECT_LT(gap(0, 1.4, 2.1), -0.001);
  EXPECT_GT(gap(0, 2.6, 4.3), 0.0005);  // until it pushes
  EXPECT_LT(gap(0, 4.3, 5.5), -0.001);
  EXPECT_GT(gap(0, 6.0, 8.8), 0.0005);  // round the duct, until it closes
  EXPECT_LT(gap(0, 8.8, 9.7), -0.0003);
  EXPECT_GT(gap(0, tools[0].duration() - 0.3, tools[0].duration()), 0.005);
}

}  // namespace
}  // namespace palpate

#include <gtest/gtest.h>

#include <cmath>

#include "common/mesh/shell_file.hpp"
#include "common/mesh/shell_generators.hpp"
#include "tests/study/small_scenes.hpp"
#include "tools/study/catheter.hpp"
#include "tools/study/dynamic.hpp"
#include "tools/study/study.hpp"

/// Bodies of two files: a catheter in its duct, a hybrid whose tensor-mass part has a mesh of its own.
namespace palpate::study {
namespace {

using namespace testing;

TEST(Study, ACatheterLedIntoItsDuctComesNearerToTheFinestWithMoreParticlesAndLeansOnTheWall) {
  const Folder folder;
  write_shell_mesh(make_tube(0.0045, 0.04, 12, 12), folder.at / "tube.msh");
  write_trajectory(folder.at);
  const Scene scene = write_scene(folder.at, R"([[body]]
name = "duct"
mesh = "tube.msh"
model = "modal_shell"
young = 3e5
poisson = 0.45
density = 1050
[[body.fixed]]
group = "end1"
[body.shell]
thickness = 0.001
modes = 20
[[body]]
name = "catheter"
model = "catheter"
young = 50e6
density = 1100
[body.catheter]
inside = "duct"
tail = [0, 0, -0.104]
tip = [0, 0, -0.004]
particles = 41
sleeve = 0.02
)",
                                  "[[tool]]\nname = \"probe\"\npivot = [0, 0.2, 0]\naxis = [0, -1, 0]\nup = "
                                  "[0, 0, 1]\nradius = 0.003\ntrajectory = \"still.csv\"\n");
  const auto method = make_catheter(scene, 1, true);
  Result result;
  for (const Point& point : method->points())
    if (point.knob == "scene" || point.knob == "particles" || point.knob == "insertion reference")
      append(result, method->evaluate(point));
  const auto row = [&](const std::string& knob, const std::string& value) {
    const Row* found = find(result, "catheter:catheter", knob, value, "finest_insertion");
    EXPECT_TRUE(found) << knob << " " << value;
    return found ? *found : Row{};
  };
  const Row coarse = row("particles", "10"), own = row("scene", ""), rest = row("insertion reference", "coarser");
  EXPECT_LT(own.err_f_rel, coarse.err_f_rel);
  EXPECT_LT(own.err_u_rel, coarse.err_u_rel);
  EXPECT_LT(rest.err_f_rel, own.err_f_rel);
  EXPECT_LT(own.err_u_rel, 0.01);
  EXPECT_LT(own.err_f_rel, 0.1);
  EXPECT_GT(own.step_us_median, 0);
  double deepest = 0, strongest = 0;
  for (const CourseRow& c : result.courses)
    if (c.method == "catheter:catheter insertion" && c.knob == "scene") {
      deepest = std::max(deepest, c.displacement_m);
      strongest = std::max(strongest, c.force_N);
    }
  EXPECT_NEAR(deepest, 0.15 * 0.1 - 0.004, 0.001);  // as far as it is led, less the way to the mouth
  EXPECT_GT(strongest, 1e-3);
}

/// A block below and one above it, which move as one hybrid; `across`, `up`: cells of the upper one, the lower has 6
/// across.
Scene stacked_scene(const Folder& folder, int across, int up) {
  write_tet_mesh(make_block({-0.03, -0.03, 0}, {0.03, 0.03, 0.02}, {6, 6, 2}), folder.at / "below.msh");
  write_tet_mesh(make_block({-0.03, -0.03, 0.02}, {0.03, 0.03, 0.04}, {across, across, up}), folder.at / "above.msh");
  write_trajectory(folder.at);
  return write_scene(
      folder.at,
      "[[body]]\nname = \"stack\"\nmesh = \"below.msh\"\nmodel = \"hybrid\"\nyoung = 4000\npoisson = 0.4\n"
      "density = 1000\n[[body.fixed]]\nbox = [[-1, -1, -1], [1, 1, 0.000001]]\n[body.hybrid]\nmesh = "
      "\"above.msh\"\n",
      kProbe);
}

TEST(Study, AHybridOfTwoMeshesThatMeetInAllNodesIsStudiedAsOneBody) {
  const Folder folder;
  const Scene scene = stacked_scene(folder, 6, 2);
  const auto whole = on_one_mesh(scene.bodies[0]);
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->mesh.nodes.size(), 7u * 7 * 5);
  const auto& region = std::get<HybridSpec>(whole->body).hybrid.regions[0];
  EXPECT_EQ(region.indices.size(), whole->mesh.tetrahedra.size() / 2);
  for (const int t : region.indices)
    for (const int n : whole->mesh.tetrahedra[t]) EXPECT_GT(whole->mesh.nodes[n].z(), 0.02 - 1e-9);
  const auto solid = std::make_shared<SolidCase>(scene, 0, *whole, true);
  for (const Patch& patch : solid->presses().patches) EXPECT_GT(patch.point.z(), 0.001);
  const auto method = make_dynamic(solid, moving_model<HybridSpec, HybridSpec>());
  const Result result = method->evaluate(method->points()[0]);
  const Row *fine = find(result, "hybrid", "scene", "", "fine_linear"),
            *same = find(result, "hybrid", "scene", "", "same_mesh");
  ASSERT_TRUE(fine && same);
  EXPECT_TRUE(std::isfinite(fine->err_f_rel));
  for (const DepthRow& d : result.depths)
    if (d.reference == "same_mesh" && d.depth_per_radius > 0.25) {
      EXPECT_LT(std::abs(d.err_f_rel), 1e-3);
    }
  // What a budget may choose, the scene's own files can say.
  for (const MovingModel& model : {moving_model<HybridSpec, HybridSpec>(), moving_model<TensorMassSpec, HybridSpec>()})
    for (const Point& point : make_dynamic(solid, model)->points())
      if (point.serves) {
        EXPECT_TRUE(model.own && point.knob != "dynamic share") << model.name << " " << point.knob;
      }
}

TEST(Study, ReferencesOfAHybridOfTwoMeshesAreKeptForBothMeshes) {
  const Folder folder;
  const ReferenceCache cache(folder.at / "references");
  int solved = 0;
  const auto press = [&](int up) {
    const Scene scene = stacked_scene(folder, 6, up);
    SolidCase solid(scene, 0, on_one(scene), true, cache, [&](const std::string&) { ++solved; });
    EXPECT_GT(solid.presses().patches[0].point.z(), 0.0399);
    return solid.fine(0)[2].force;
  };
  const double coarse = press(2), fine = press(4);
  EXPECT_EQ(solved, 2);
  EXPECT_NE(coarse, fine);
  EXPECT_EQ(press(2), coarse);
  EXPECT_EQ(solved, 2);
}

TEST(Study, AHybridOfTwoMeshesThatMeetAtSomeNodesIsNotAssessedAndTheNotesSayWhy) {
  const Folder folder;
  const Result result = run_study(stacked_scene(folder, 3, 2), folder.at / "out", {.quick = true});
  ASSERT_EQ(result.rows.size(), 1u);
  EXPECT_EQ(result.rows[0].knob, "connection");
  EXPECT_TRUE(std::isnan(result.rows[0].err_u_rel));
  ASSERT_EQ(result.notes.size(), 1u);
  EXPECT_NE(result.notes[0].text.find("not assessed"), std::string::npos);
}

}  // namespace
}  // namespace palpate::study

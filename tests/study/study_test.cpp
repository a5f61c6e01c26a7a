#include "tools/study/study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "common/mesh/shell_file.hpp"
#include "common/mesh/shell_generators.hpp"
#include "common/realtime/shutdown.hpp"
#include "tests/sanitized.hpp"
#include "tests/study/small_scenes.hpp"
#include "tools/study/modal.hpp"
#include "tools/study/patches.hpp"
#include "tools/study/quasi_static.hpp"
#include "tools/study/reference_cache.hpp"
#include "tools/study/solid_case.hpp"
#include "tools/study/store.hpp"

/// Whole studies of small bodies, in quick mode.
namespace palpate::study {
namespace {

using std::filesystem::path;
using namespace testing;

TEST(Patches, AreTheSameEachTimeOnTheTouchableSurfaceAndApart) {
  const Folder folder;
  const Scene scene = block_scene(folder.at);
  const SolidCase one(scene, 0, on_one(scene), false), two(scene, 0, on_one(scene), false);
  ASSERT_EQ(one.presses().patches.size(), 3u);
  EXPECT_EQ(one.presses().radius, 0.012);
  for (std::size_t p = 0; p < 3; ++p) {
    const Patch& patch = one.presses().patches[p];
    EXPECT_EQ(patch.point, two.presses().patches[p].point);
    EXPECT_GT(patch.point.z(), 0.001);  // the bottom is fixed
    EXPECT_NEAR(patch.inward.norm(), 1, 1e-12);
    EXPECT_LT(patch.inward.dot(patch.point - Eigen::Vector3d(0, 0, 0.015)), 0);
    for (std::size_t q = 0; q < p; ++q) EXPECT_GT((patch.point - one.presses().patches[q].point).norm(), 0.01);
  }
}

TEST(Study, ThatIsStoppedSaysWhatStays) {
  const Folder folder;
  const Scene scene = block_scene(folder.at);
  StudyOptions options = quick();
  options.say = [](const std::string&) { request_shutdown(); };
  try {
    run_study(scene, folder.at / "out", options);
    FAIL() << "it was not stopped";
  } catch (const Interrupted& stop) {
    EXPECT_NE(std::string(stop.what()).find(" settings, which stay in "), std::string::npos) << stop.what();
  }
  clear_shutdown();
  EXPECT_TRUE(std::filesystem::exists(folder.at / "out/study.csv"));
}

TEST(Study, OfABlockHasItsColumnsItsReferencesAndErrorsThatFallWhereTheyMust) {
  const Folder folder;
  const Scene scene = block_scene(folder.at);
  const Result result = run_study(scene, folder.at / "out", quick());
  const std::string csv = text_of(folder.at / "out/study.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "scene,method,knob,value,step_us_median,step_us_p99,offline_s,memory_bytes,err_u_rel,err_f_rel,"
            "reference");
  for (std::size_t at = 0, end; (end = csv.find('\n', at)) != std::string::npos; at = end + 1)
    EXPECT_EQ(std::count(csv.begin() + at, csv.begin() + end, ','), 10);

  const Row* as_is = find(result, "quasi_static", "scene", "", "fine_linear");
  ASSERT_TRUE(as_is);
  EXPECT_GT(as_is->step_us_median, 0);
  EXPECT_LE(as_is->step_us_median, as_is->step_us_p99);
  if (!palpate::testing::kSanitized) {
    EXPECT_GT(as_is->memory_bytes, 8.0 * 300 * 300);
  }
  EXPECT_GT(as_is->offline_s, 0);
  // Rounded tensors are not quite the same.
  const Row* single = find(result, "quasi_static", "precision", "single", "fine_linear");
  ASSERT_TRUE(single);
  EXPECT_NE(single->err_f_rel, as_is->err_f_rel);
  EXPECT_NEAR(single->err_f_rel, as_is->err_f_rel, 1e-4);
  // Fewer tensors, nearly the same answer in less memory: the patch's near field knows less about it.
  const Row* few = find(result, "quasi_static", "tensors", "", "fine_linear");
  ASSERT_TRUE(few);
  EXPECT_NEAR(few->err_f_rel, as_is->err_f_rel, 0.02);
  if (!palpate::testing::kSanitized) {
    EXPECT_LT(few->memory_bytes, 0.8 * as_is->memory_bytes);
  }

  // The reference knows its own error, which is less than that of what it judges, but for the patch's.
  const Row* rest = find(result, "reference", "mesh", "coarser", "fine_linear");
  const Row* by_nodes = find(result, "quasi_static", "rule", "barycentric", "fine_linear");
  ASSERT_TRUE(rest && by_nodes);
  EXPECT_LT(rest->err_f_rel, 0.5 * by_nodes->err_f_rel);
  EXPECT_LT(rest->err_u_rel, by_nodes->err_u_rel);
  EXPECT_LT(as_is->err_f_rel, 1.5 * rest->err_f_rel);
  EXPECT_LT(rest->err_u_rel, as_is->err_u_rel);

  // A slide for each rule, without friction and with it; the patch, which sticks to no node, drags by Coulomb's law.
  const auto touch = [&](const std::string& value, double friction) {
    for (const TouchRow& t : result.touches)
      if (t.method == "quasi_static" && t.value == value && t.friction == friction) return t;
    ADD_FAILURE() << value << " " << friction;
    return TouchRow{};
  };
  // Bounds are one and a half times what is measured.
  const auto by_patch = [](std::string_view rule) { return rule == "as it is"; };
  for (const char* rule : {"as it is", "alpha", "barycentric"}) {
    const TouchRow free = touch(rule, 0);
    EXPECT_GT(free.ripple, 1e-3);
    EXPECT_LT(free.ripple, by_patch(rule) ? 0.025 : 0.09) << rule;
    EXPECT_GT(free.spread, free.ripple) << rule;
    EXPECT_LT(free.spread, by_patch(rule) ? 0.2 : 0.3) << rule;
  }
  for (const double friction : {0.0, 0.3}) {
    const TouchRow own = touch("as it is", friction);
    EXPECT_LT(own.ripple, 0.045) << friction;
    EXPECT_LT(own.jump, 0.0013) << friction;
    EXPECT_LT(own.buzz, 4e-5) << friction;
    EXPECT_EQ(own.turn, 0) << friction;
  }
  const double dragged = std::hypot(1, 0.3) * touch("as it is", 0).mean_force_N;
  EXPECT_NEAR(touch("as it is", 0.3).mean_force_N, dragged, 0.03 * dragged)
      << "but for what shear does along the normal";
  for (const Note& note : result.notes) EXPECT_EQ(note.text.find("slide"), std::string::npos) << note.text;
  double least = 1e300, most = 0;
  for (const SlideRow& r : result.slides) {
    least = std::min(least, r.reference_force_N);
    most = std::max(most, r.reference_force_N);
  }
  EXPECT_LT(most, 1.3 * least);
  EXPECT_NEAR(most, result.depths[2].reference_force_N, 0.01 * most) << "the slide passes through the first place";

  // Tensor-mass tissue comes to rest where the tensors are, and springs do not, once the ball has come to the
  // nodes.
  int compared = 0;
  for (const DepthRow& d : result.depths) {
    if (d.reference != "same_mesh" || d.knob != "model" || d.depth_per_radius < 0.25) continue;
    ++compared;
    const double least = std::min(d.err_u_rel, std::abs(d.err_f_rel)),
                 most = std::max(d.err_u_rel, std::abs(d.err_f_rel));
    if (d.method == "tensor_mass") {
      EXPECT_LT(most, 1e-3);
    } else {
      EXPECT_GT(least, 0.05);
    }
  }
  EXPECT_EQ(compared, 8);
}

TEST(Study, TensorsFromAFinerMeshAreNearerToTheReferenceWhereTheMeshLocks) {
  const Folder folder;
  Scene scene = block_scene(folder.at);
  as<SolidSpec>(scene.bodies[0])->material.poisson = 0.499;
  scene.contact.rule = ContactRule::barycentric;
  const auto solid = std::make_shared<SolidCase>(scene, 0, on_one(scene), true, ReferenceCache(kept_references()));
  const auto method = make_quasi_static(solid);
  const auto from = [&](const Offline& offline) {
    const auto apply = [&](Scene& s) { as<QuasiStaticSpec>(s.bodies[0])->offline = offline; };
    return method->evaluate({"quasi_static", "offline", "", apply, true});
  };
  const Result as_is = from({}), finer = from({.refine = 1});
  ASSERT_FALSE(as_is.rows.empty() || finer.rows.empty());
  // Where the ball has come to the nodes.
  ASSERT_EQ(as_is.depths.size(), finer.depths.size());
  for (std::size_t i = 0; i < as_is.depths.size(); ++i) {
    const DepthRow &before = as_is.depths[i], &after = finer.depths[i];
    if (before.reference != "fine_linear" || before.depth_per_radius < 0.45) continue;
    std::printf("depth %.2f R: force off by %.1f %%, from the finer mesh %.1f %%\n", before.depth_per_radius,
                100 * before.err_f_rel, 100 * after.err_f_rel);
    EXPECT_LT(std::abs(after.err_f_rel), std::abs(before.err_f_rel));
  }
}

TEST(Study, TensorsFromQuadraticAndLockingFreeElementsArePressed) {
  const Folder folder;
  const Scene scene = block_scene(folder.at);
  const auto method =
      make_quasi_static(std::make_shared<SolidCase>(scene, 0, on_one(scene), true, ReferenceCache(kept_references())));
  for (const Offline& offline :
       {Offline{.element = FiniteElement::p2}, Offline{.refine = 1, .formulation = Formulation::locking_free}}) {
    const auto apply = [&](Scene& s) { as<QuasiStaticSpec>(s.bodies[0])->offline = offline; };
    const Result result =
        method->evaluate({"quasi_static", "offline", std::string(word_of(offline.element)), apply, true});
    const Row* row = find(result, "quasi_static", "offline", "", "fine_linear");
    ASSERT_TRUE(row);
    EXPECT_LT(row->err_u_rel, 1);
    EXPECT_LT(row->err_f_rel, 1);
  }
}

TEST(Study, ReferencesThatWereKeptAreTheSameNumbersAndAnotherPressHasItsOwn) {
  const Folder folder;
  const Scene scene = block_scene(folder.at);
  const ReferenceCache cache(folder.at / "references");
  int solved = 0;
  const auto say = [&](const std::string&) { ++solved; };
  SolidCase first(scene, 0, on_one(scene), true, cache, say), second(scene, 0, on_one(scene), true, cache, say);
  const double force = first.fine(0)[1].force;
  EXPECT_EQ(solved, 1);
  EXPECT_EQ(second.fine(0)[1].force, force);
  EXPECT_EQ(second.fine(0)[1].displacement, first.fine(0)[1].displacement);
  EXPECT_EQ(solved, 1);
  Scene stiffer = scene;
  as<SolidSpec>(stiffer.bodies[0])->material.young *= 2;
  SolidCase other(stiffer, 0, on_one(stiffer), true, cache, say);
  EXPECT_NEAR(other.fine(0)[1].force, 2 * force, 1e-6 * force);
  EXPECT_EQ(solved, 2);
}

TEST(Study, ReferencesAreRefinedFromAMeshOfAnySize) {
  const Folder folder;
  Scene scene = block_scene(folder.at);
  write_tet_mesh(make_block({-0.03, -0.03, 0}, {0.03, 0.03, 0.03}, {24, 24, 12}), folder.at / "block.msh");
  const SolidCase solid(scene, 0, on_one(scene), true, ReferenceCache(kept_references()));
  ASSERT_GT(solid.mesh().nodes.size(), 8000u);
  int strides = 0;
  const auto place = std::span(solid.presses().patches).first(1);
  const StaticProblem finer = solid.refined(place, {1, 1 / 9.0, 0.6, 3000}, strides);
  EXPECT_GT(finer.mesh.nodes.size(), solid.mesh().nodes.size() + 500);
  EXPECT_LE(finer.mesh.nodes.size(), solid.mesh().nodes.size() + 3000);
}

TEST(ReferenceCache, ComputesOnceAndAgainWhereTheFileIsDamaged) {
  const Folder folder;
  const ReferenceCache cache(folder.at / "kept");
  int computed = 0;
  const auto compute = [&] { return std::vector<double>{1, 2, ++computed + 0.5}; };
  EXPECT_EQ(cache.get("a", compute), (std::vector<double>{1, 2, 1.5}));
  EXPECT_EQ(cache.get("a", compute), (std::vector<double>{1, 2, 1.5}));
  EXPECT_EQ(cache.get("b", compute), (std::vector<double>{1, 2, 2.5}));
  for (const auto& entry : std::filesystem::directory_iterator(folder.at / "kept")) {
    std::fstream file(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(40);
    file.put('x');
  }
  EXPECT_EQ(cache.get("a", compute), (std::vector<double>{1, 2, 3.5}));
  EXPECT_EQ(ReferenceCache().get("a", compute), (std::vector<double>{1, 2, 4.5}));
}

TEST(Study, TheErrorOfBeingLinearGrowsWithDepth) {
  const Folder folder;
  const Scene scene = block_scene(folder.at);
  SolidCase solid(scene, 0, on_one(scene), true, ReferenceCache(kept_references()));
  const auto& both = solid.nonlinearity(0);
  ASSERT_TRUE(both.gave_up.empty()) << both.gave_up;
  ASSERT_EQ(both.linear.size(), both.neo_hookean.size());
  const auto error = [&](std::size_t d) {
    return solid.errors().of_field(both.linear[d].displacement, both.neo_hookean[d].displacement);
  };
  EXPECT_GT(error(0), 0);
  EXPECT_GT(error(both.linear.size() - 1), 1.5 * error(0));
  EXPECT_LT(both.penetration, 2e-3 * solid.presses().radius);
  // What the law changes on one mesh is what the reference has beyond the fine linear one.
  const PressAnswers reference = solid.neo_hookean();
  ASSERT_EQ(reference[0].size(), both.linear.size());
  for (std::size_t d = 0; d < both.linear.size(); ++d) {
    const PressAnswer &law = reference[0][d], &fine = solid.fine(0)[d];
    EXPECT_NEAR(law.force - fine.force, both.neo_hookean[d].force - both.linear[d].force, 1e-9 * fine.force);
    for (std::size_t n = 0; n < fine.displacement.size(); n += 7)
      EXPECT_NEAR((law.displacement[n] - fine.displacement[n] - both.neo_hookean[d].displacement[n] +
                   both.linear[d].displacement[n])
                      .norm(),
                  0, 1e-12);
  }
}

TEST(Study, GoesOnWhereItWasAndStartsAfreshForAnotherScene) {
  const Folder folder;
  const Scene scene = block_scene(folder.at);
  const Store store(folder.at, study_key(scene, true));
  const Point point{"quasi_static", "scene", "as it is", {}, true};
  EXPECT_FALSE(store.find(point));
  Result result;
  result.rows.push_back(
      {"small", "quasi_static", "scene", "as it is", 1.5, 2.5, kUnknown, 4e6, 0.25, 0.125, "fine_linear"});
  result.courses.push_back({"small", "quasi_static", "scene", "as it is", 0.001, 1, 2, 3, 4});
  result.slides.push_back({"small", "quasi_static", "scene", "as it is", 0.3, 0.001, 5, -6, 7});
  result.touches.push_back({"small", "quasi_static", "scene", "as it is", 0.3, 2, 0.01, 0.02, 0.5, 0.03});
  result.notes.push_back({"small", "quasi_static", "scene", "as it is", "with, commas"});
  store.keep(point, result);
  const auto found = Store(folder.at, study_key(scene, true)).find(point);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->rows.size(), 1u);
  EXPECT_EQ(found->rows[0].err_f_rel, 0.125);
  EXPECT_TRUE(std::isnan(found->rows[0].offline_s));
  EXPECT_EQ(found->courses[0].reference_displacement_m, 4);
  EXPECT_EQ(found->slides[0].tangential_N, -6);
  EXPECT_EQ(found->slides[0].reference_force_N, 7);
  EXPECT_EQ(found->touches[0].turn, 0.5);
  EXPECT_EQ(found->touches[0].buzz, 0.03);
  EXPECT_TRUE(std::isnan(found->touches[0].spread));
  EXPECT_EQ(found->notes[0].text, "with; commas");
  for (const auto& file : std::filesystem::directory_iterator(folder.at / "points"))
    if (file.path().extension() == ".csv") std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  EXPECT_FALSE(store.find(point)) << "a torn file counts as none";
  store.keep(point, result);
  Scene other = scene;
  as<SolidSpec>(other.bodies[0])->material.young *= 2;
  EXPECT_FALSE(Store(folder.at, study_key(other, true)).find(point));
}

TEST(Study, AShellsErrorsFallWithItsModesAndResidualFlexibilityTakesThemAwayAtRest) {
  const Folder folder;
  write_shell_mesh(make_tube(0.0045, 0.04, 12, 12), folder.at / "tube.msh");
  write_trajectory(folder.at);
  const Scene scene = write_scene(folder.at, R"([[body]]
name = "duct"
mesh = "tube.msh"
model = "modal_shell"
young = 1e5
poisson = 0.45
density = 1050
[[body.fixed]]
group = "end0"
[body.shell]
thickness = 0.0008
modes = 20
)",
                                  "[[tool]]\nname = \"probe\"\npivot = [0, 0.2, 0]\naxis = [0, -1, 0]\nup = "
                                  "[0, 0, 1]\nradius = 0.003\ntrajectory = \"still.csv\"\n");
  StudyOptions options = quick();
  options.budget = 1;
  options.budget_text = "1 s";
  const Result result = run_study(scene, folder.at / "out", options);
  const auto row = [&](const std::string& knob, const std::string& modes, const std::string& reference) {
    const Row* found = find(result, "modal_shell", knob, modes, reference);
    EXPECT_TRUE(found) << knob << " " << modes << " " << reference;
    return found ? *found : Row{};
  };
  EXPECT_LT(row("modes without residual", "20", "all_modes").err_u_rel,
            row("modes without residual", "5", "all_modes").err_u_rel);
  EXPECT_LT(row("modes without residual", "50", "all_modes").err_u_rel,
            row("modes without residual", "20", "all_modes").err_u_rel);
  EXPECT_LT(row("modes", "5", "all_modes").err_u_rel, 1e-3);
  EXPECT_LT(row("modes", "50", "all_modes_in_time").err_f_rel, row("modes", "5", "all_modes_in_time").err_f_rel);

  // With time in plenty the budget buys what is most accurate, and the scene that it writes is that one.
  const Scene bought = load_scene(folder.at / "out/small_within_1s.toml");
  Row best;
  double least = 1e9;
  for (const Row& still : result.rows)
    for (const Row& moving : result.rows) {
      const bool pair = still.knob == moving.knob && still.value == moving.value && still.reference == "all_modes" &&
                        moving.reference == "all_modes_in_time";
      const double worst = std::max({still.err_u_rel, still.err_f_rel, moving.err_u_rel, moving.err_f_rel});
      if (pair && worst < least) best = still, least = worst;
    }
  const auto& duct = std::get<ModalShellSpec>(bought.bodies[0]);
  EXPECT_EQ(duct.shell.modes, best.knob == "scene" ? 20 : std::stoi(best.value));
  EXPECT_TRUE(duct.shell.residual);
  EXPECT_EQ(duct.mesh, as<MeshedSpec>(scene.bodies[0])->mesh);
  // Everything is kept: a second run computes nothing.
  std::vector<std::string> said;
  StudyOptions again = options;
  again.say = [&](const std::string& line) { said.push_back(line); };
  run_study(scene, folder.at / "out", again);
  ASSERT_FALSE(said.empty());
  for (std::size_t i = 0; i + 1 < said.size(); ++i) EXPECT_NE(said[i].find("kept"), std::string::npos) << said[i];
}

TEST(Study, ACathetersErrorFallsWithItsParticles) {
  const Folder folder;
  const Scene scene = catheter_scene(folder.at, 40);
  const Result result = run_study(scene, folder.at / "out", quick());
  const Row *coarse = find(result, "catheter", "particles", "10", "finest_chain"),
            *own = find(result, "catheter", "scene", "", "finest_chain"),
            *fine = find(result, "catheter", "particles", "80", "finest_chain");
  ASSERT_TRUE(coarse && own && fine);
  EXPECT_LT(own->err_f_rel, coarse->err_f_rel);
  EXPECT_LT(fine->err_f_rel, own->err_f_rel);
  if (!palpate::testing::kSanitized) {
    EXPECT_LT(own->memory_bytes, fine->memory_bytes);
  }
}

TEST(Study, MovingTissueComesNearerToItsOwnSmallStepsWithSmallerStepsAndAfterACutToAFreshSolve) {
  const Folder folder;
  const Scene scene = block_scene(folder.at, "model = \"tensor_mass\"\n");
  const Result result = run_study(scene, folder.at / "out", quick());
  std::vector<Row> steps;
  for (const Row& r : result.rows)
    if (r.method == "tensor_mass" && r.knob == "step" && r.reference == "small_step") steps.push_back(r);
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_LT(steps[1].err_f_rel, steps[0].err_f_rel);
  const Row *cut = find(result, "tensor_mass", "cut", "", "cut_mesh"),
            *stale = find(result, "quasi_static", "cut", "", "cut_mesh");
  ASSERT_TRUE(cut && stale);
  EXPECT_LT(cut->err_u_rel, 1e-3);
  EXPECT_GT(stale->err_u_rel, 10 * cut->err_u_rel);
}

}  // namespace
}  // namespace palpate::study

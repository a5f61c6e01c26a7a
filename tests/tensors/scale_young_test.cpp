#include "common/archive/scale_young.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <span>

#include "common/mesh/shell_generators.hpp"
#include "common/models/content_hash.hpp"
#include "common/models/hybrid/precompute.hpp"
#include "common/models/modal_shell/precompute.hpp"
#include "common/models/moving/precompute.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "tests/fem/meshes_for_tests.hpp"
#include "tests/tensors/files_for_tests.hpp"

namespace palpate {
namespace {

constexpr double kFactor = 2.7;

/// By the largest of them.
void expect_close(std::span<const double> a, std::span<const double> b, const char* what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  double size = 0, worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    size = std::max(size, std::abs(b[i]));
    worst = std::max(worst, std::abs(a[i] - b[i]));
  }
  EXPECT_LE(worst, 1e-6 * size) << what;
}

void expect_close(const std::vector<PressedPlace>& a, const std::vector<PressedPlace>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i].depth, b[i].depth, 1e-6 * b[i].depth);
    ASSERT_EQ(a[i].force.size(), b[i].force.size());
    for (std::size_t k = 0; k < a[i].force.size(); ++k) expect_close(a[i].force[k], b[i].force[k], "force");
    ASSERT_EQ(a[i].radial.size(), b[i].radial.size());
    for (std::size_t k = 0; k < a[i].radial.size(); ++k) expect_close(a[i].radial[k], b[i].radial[k], "radial");
  }
}

/// That the archive of one body, scaled, is that of the other, which is as much stiffer and has the same file.
template <class Spec>
void expect_scales(const Spec& soft, const std::function<Archive(const Spec&)>& compute) {
  Spec stiff = soft;
  stiff.material.young *= kFactor;
  if constexpr (requires { stiff.materials; })
    for (MaterialRegion& region : stiff.materials) region.material.young *= kFactor;
  Archive a = compute(soft);
  const Archive b = compute(stiff);
  scale_young(a, stiff.material.young);
  EXPECT_EQ(a.young[0], b.young[0]);
  expect_close(a.young, b.young, "young");
  expect_close(a.touchable_compliance, b.touchable_compliance, "touchable");
  expect_close(a.other_compliance, b.other_compliance, "other");
  expect_close(a.moving_compliance, b.moving_compliance, "moving");
  expect_close({&a.specimen_force_slope, 1}, {&b.specimen_force_slope, 1}, "force slope");
  expect_close({&a.specimen_radial_slope, 1}, {&b.specimen_radial_slope, 1}, "radial slope");
  expect_close(a.presses, b.presses);
  ASSERT_EQ(a.condensed.has_value(), b.condensed.has_value());
  if (a.condensed) {
    expect_close({&a.condensed->bound, 1}, {&b.condensed->bound, 1}, "bound");
    expect_close(a.condensed->mass, b.condensed->mass, "mass");
    expect_close(a.condensed->stiffness, b.condensed->stiffness, "stiffness");
    expect_close(a.condensed->reaction, b.condensed->reaction, "reaction");
    expect_close(a.condensed->follow, b.condensed->follow, "follow");
    expect_close(a.condensed->sag, b.condensed->sag, "sag");
  }
  ASSERT_EQ(a.modal.has_value(), b.modal.has_value());
  if (a.modal) {
    expect_close(a.modal->omega, b.modal->omega, "omega");
    expect_close(a.modal->mass, b.modal->mass, "mass of modes");
  }
}

/// The same body of another kind.
template <class Spec>
Spec block_of(double poisson = 0.4) {
  Spec spec;
  static_cast<SolidSpec&>(spec) = testing::make_body(5e3, poisson);
  return spec;
}

TetMesh block_mesh() {
  return make_block({-0.02, -0.02, 0}, {0.02, 0.02, 0.02}, {4, 4, 2});
}

MaterialRegion stiff_part() {
  MaterialRegion region;
  region.where.indices = {0, 1, 2, 3, 4, 5};
  region.material = {5e4, 0.3, 1000};
  return region;
}

TEST(ScaleYoung, IsAFreshArchiveOfTwoMaterialsWithASpecimen) {
  auto body = testing::make_body();
  body.materials = {stiff_part()};
  body.nonlinear = Nonlinear{MeasuredLaw{.specimen_mesh = "cylinder"}};
  body.touchable = NodeSelector{{{}, Box{{-1, -1, 0.03}, {1, 1, 1}}, ""}};
  const TetMesh mesh = testing::make_organ({4, 4, 3}), specimen = make_cylinder(0.015, 0.013, 3, 2);
  expect_scales<QuasiStaticSpec>(body, [&](const auto& b) { return precompute(b, mesh, &specimen); });
}

TEST(ScaleYoung, IsAFreshArchiveOfQuadraticElements) {
  auto body = testing::make_body();
  body.offline = Offline{0, FiniteElement::p2, Formulation::locking_free};
  const TetMesh mesh = testing::make_organ({3, 3, 2});
  expect_scales<QuasiStaticSpec>(body, [&](const auto& b) { return precompute(b, mesh); });
}

TEST(ScaleYoung, IsAFreshArchiveOfNeoHookeanPresses) {
  auto body = block_of<QuasiStaticSpec>();
  body.nonlinear = Nonlinear{NeoHookeanLaw{.ball_radius = 0.008, .places = 1}};
  const TetMesh mesh = make_block({-0.03, -0.03, 0}, {0.03, 0.03, 0.03}, {4, 4, 2});
  expect_scales<QuasiStaticSpec>(body, [&](const auto& b) { return precompute(b, mesh); });
}

TEST(ScaleYoung, IsAFreshArchiveOfTissueThatMoves) {
  auto body = block_of<TensorMassSpec>();
  body.materials = {stiff_part()};
  const TetMesh mesh = block_mesh();
  expect_scales<TensorMassSpec>(body, [&](const auto& b) { return precompute_moving(b, TensorMassSpec::kKind, mesh); });
}

TEST(ScaleYoung, IsAFreshArchiveOfAHybridUnderGravity) {
  auto body = block_of<HybridSpec>();
  body.dynamic.gravity = {0, 0, -9.81};
  body.hybrid.regions.push_back({{{}, Box{{-1, -1, 0.01}, {0.02, 1, 1}}, ""}});
  const TetMesh mesh = block_mesh();
  expect_scales<HybridSpec>(body, [&](const auto& b) { return precompute(b, mesh); });
}

TEST(ScaleYoung, IsAFreshArchiveOfAShell) {
  ModalShellSpec body;
  body.name = "duct";
  body.material = {1e5, 0.4, 1050};
  body.shell.thickness = 0.001;
  body.shell.modes = 12;
  body.fixed.emplace_back();
  body.fixed[0].where.group = "end1";
  const ShellMesh mesh = make_tube(0.0045, 0.04, 12, 6);
  expect_scales<ModalShellSpec>(body, [&](const auto& b) { return precompute(b, mesh); });
}

TEST(ScaleYoung, ChangesNothingOfTheSameBody) {
  auto archive = testing::make_hybrid_archive(20, 8);
  scale_young(archive, archive.young[0]);
  EXPECT_TRUE(testing::same(archive, testing::make_hybrid_archive(20, 8)));
}

class ArchiveHash : public ::testing::Test {
 protected:
  ArchiveHash() {
    testing::write_bytes(folder / "organ.msh", {'m'}, 1);
    body = testing::make_body();
    body.mesh = folder / "organ.msh";
    body.materials = {stiff_part()};
  }
  testing::TemporaryFolder folder;
  QuasiStaticSpec body;
};

TEST_F(ArchiveHash, LeavesOutAFactorCommonToAllModuliAlone) {
  const std::string file = archive_hash(body), content = content_hash(body);
  body.material.young *= 1.1;
  EXPECT_NE(archive_hash(body), file);
  body.materials[0].material.young *= 1.1;
  EXPECT_EQ(archive_hash(body), file);
  EXPECT_NE(content_hash(body), content);
  body.material.poisson = 0.3;
  EXPECT_NE(archive_hash(body), file);
}

}  // namespace
}  // namespace palpate

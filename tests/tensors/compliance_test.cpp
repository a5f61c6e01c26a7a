#include "common/archive/compliance.hpp"

#include <gtest/gtest.h>

#include "common/models/quasi_static/precompute.hpp"
#include "tests/fem/meshes_for_tests.hpp"

namespace palpate {
namespace {

Archive partly_fixed_archive() {
  auto body = testing::make_body();
  body.fixed = {testing::fix_group("z0"), testing::fix_group("x1", {true, false, false})};
  body.touchable = NodeSelector{};
  body.touchable->box = Box{{0, -1, -1}, {1, 1, 1}};
  return precompute(body, testing::make_organ({6, 5, 4}));
}

double entry(const Archive& archive, std::size_t i, std::size_t j) {
  if (i < j) std::swap(i, j);
  return archive.touchable_compliance[i * (i + 1) / 2 + j];
}

template <class Scalar>
class ComplianceOf : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(ComplianceOf, Scalars);

TYPED_TEST(ComplianceOf, HoldsEveryEntryOfTheArchiveInItsPlace) {
  const auto archive = partly_fixed_archive();
  ASSERT_GT(archive.other_dofs.size(), 0u);
  const Compliance<TypeParam> compliance(archive, Compliance<TypeParam>::Rows::surface);
  const auto& columns = archive.touchable_dofs;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const TypeParam* column = compliance.column(columns[j].node, columns[j].axis);
    for (std::size_t i = 0; i < columns.size(); ++i)
      ASSERT_EQ(column[3 * columns[i].node + columns[i].axis], static_cast<TypeParam>(entry(archive, i, j)));
    for (std::size_t i = 0; i < archive.other_dofs.size(); ++i)
      ASSERT_EQ(column[3 * archive.other_dofs[i].node + archive.other_dofs[i].axis],
                static_cast<TypeParam>(archive.other_compliance[i * columns.size() + j]));
  }
}

TYPED_TEST(ComplianceOf, IsZeroInRowsAndColumnsOfFixedAxes) {
  const auto archive = partly_fixed_archive();
  const Compliance<TypeParam> compliance(archive, Compliance<TypeParam>::Rows::surface);
  int fixed = 0;
  for (int node = 0; node < archive.surface.size(); ++node)
    for (int axis = 0; axis < 3; ++axis) {
      if (!archive.surface.fixed[node][axis]) continue;
      ++fixed;
      for (int k = 0; k < 3 * compliance.column_nodes(); ++k)
        ASSERT_EQ(compliance.column(k / 3, k % 3)[3 * node + axis], 0);
      for (int row = 0; node < compliance.column_nodes() && row < 3 * compliance.row_nodes(); ++row)
        ASSERT_EQ(compliance.column(node, axis)[row], 0);
    }
  EXPECT_GT(fixed, 0);
}

TYPED_TEST(ComplianceOf, IsAlignedAndPadded) {
  const auto archive = partly_fixed_archive();
  for (auto rows : {Compliance<TypeParam>::Rows::touchable, Compliance<TypeParam>::Rows::surface}) {
    const Compliance<TypeParam> compliance(archive, rows);
    EXPECT_EQ(compliance.stride() % 16, 0);
    EXPECT_GE(compliance.stride(), 3 * compliance.row_nodes());
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(compliance.column(1, 2)) % 64, 0u);
  }
}

TEST(Compliance, OfTheHapticNodeNeedsNoOtherRows) {
  auto archive = partly_fixed_archive();
  archive.other_compliance.clear();
  using Haptic = Compliance<double>;
  EXPECT_EQ(Haptic(archive, Haptic::Rows::touchable).row_nodes(), archive.surface.touchable);
  EXPECT_THROW(Haptic(archive, Haptic::Rows::surface), std::runtime_error);
  archive.touchable_compliance.clear();
  EXPECT_THROW(Haptic(archive, Haptic::Rows::touchable), std::runtime_error);
}

TEST(SurfaceMap, PutsTouchableNodesFirstAndBothGroupsAscend) {
  const auto archive = partly_fixed_archive();
  const auto& map = archive.surface;
  ASSERT_GT(map.touchable, 0);
  ASSERT_LT(map.touchable, map.size());
  const auto split = map.node_number.begin() + map.touchable;
  EXPECT_TRUE(std::is_sorted(map.node_number.begin(), split));
  EXPECT_TRUE(std::is_sorted(split, map.node_number.end()));
  for (int i = 0; i < map.touchable; ++i) {
    EXPECT_GE(map.position[i].x(), 0);
    EXPECT_FALSE(map.fixed[i][0] && map.fixed[i][1] && map.fixed[i][2]);
  }
  for (const auto& dof : archive.touchable_dofs) EXPECT_FALSE(map.fixed[dof.node][dof.axis]);
}

TEST(SurfaceMap, RefusesATouchableSetWithoutFreeSurfaceNodes) {
  auto body = testing::make_body();
  body.touchable = NodeSelector{};
  body.touchable->group = "z0";
  EXPECT_THROW(precompute(body, testing::make_organ({3, 3, 3})), std::runtime_error);
}

}  // namespace
}  // namespace palpate

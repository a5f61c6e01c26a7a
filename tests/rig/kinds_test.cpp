#include "tools/rig/kinds.hpp"

#include <gtest/gtest.h>

#include "common/dynamics/spring_mass.hpp"
#include "tools/rig/example_bodies.hpp"

namespace palpate {
namespace {

TEST(BodyAsAnotherKind, KeepsWhatBothHaveInCommon) {
  HybridSpec hybrid = block_body<HybridSpec>();
  hybrid.dynamic.damping = 7;
  hybrid.hybrid.scale = 2;
  const Body body = hybrid;
  EXPECT_EQ(as_kind<TensorMassSpec>(body).dynamic.damping, 7);
  EXPECT_EQ(as_kind<QuasiStaticSpec>(body).fixed.size(), 1u);
  EXPECT_EQ(as_kind<ModalShellSpec>(body).material.young, 5000);
  EXPECT_EQ(as_kind<CatheterSpec>(body).name, "block");
  EXPECT_EQ(as_kind<HybridSpec>(body).hybrid.scale, 2);
  EXPECT_EQ(as_kind<HybridSpec>(Body(as_kind<SpringMassSpec>(body))).hybrid.scale, 1);
}

TEST(BodyAsAnotherKind, OfSpringsHasNoElements) {
  TensorMassSpec averaged = block_body<TensorMassSpec>(), turning = averaged;
  averaged.dynamic.element = TetElement::nodal_strain;
  turning.dynamic.corotational = true;
  for (const TensorMassSpec& from : {averaged, turning}) {
    const auto springs = as_kind<SpringMassSpec>(from);
    EXPECT_TRUE(springs.dynamic.element == TetElement::linear && !springs.dynamic.corotational);
    EXPECT_EQ(springs.dynamic.damping, from.dynamic.damping);
  }
}

TEST(BodyOfAnyKind, SaysHowItMoves) {
  Body moving = block_body<SpringMassSpec>(), still = block_body<QuasiStaticSpec>();
  ASSERT_TRUE(find_motion(moving));
  motion_of(moving).damping = 3;
  EXPECT_EQ(std::get<SpringMassSpec>(moving).dynamic.damping, 3);
  const ElasticMesh mesh = elastic_mesh(precompute_on(moving, small_block_mesh()));
  EXPECT_TRUE(dynamic_cast<SpringMass<float>*>(make_model(moving, mesh).get()));
  EXPECT_FALSE(find_motion(still));
  EXPECT_EQ(make_model(still, mesh), nullptr);
  EXPECT_THROW(precompute_on(CatheterSpec{}, small_block_mesh()), std::logic_error);
}

}  // namespace
}  // namespace palpate

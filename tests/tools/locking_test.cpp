#include <gtest/gtest.h>

#include "common/models/body.hpp"

namespace palpate {
namespace {

template <class Spec>
Spec body_of(double poisson) {
  Spec body;
  body.name = "organ";
  body.material = {1e4, poisson, 1000};
  return body;
}

TEST(LockingWarning, NamesTheCureWhereLinearElementsAreTooStiff) {
  EXPECT_TRUE(locking_warnings(body_of<QuasiStaticSpec>(0.47)).empty());
  const auto still = locking_warnings(body_of<QuasiStaticSpec>(0.49));
  ASSERT_EQ(still.size(), 1u);
  EXPECT_NE(still[0].find("locking_free"), std::string::npos);
  const auto moving = locking_warnings(body_of<TensorMassSpec>(0.49));
  ASSERT_EQ(moving.size(), 1u);
  EXPECT_EQ(moving[0].find("locking_free"), std::string::npos);
  EXPECT_NE(moving[0].find("nodal_strain"), std::string::npos);
  auto averaged = body_of<TensorMassSpec>(0.49);
  averaged.dynamic.element = TetElement::nodal_strain;
  EXPECT_TRUE(locking_warnings(averaged).empty());
  EXPECT_TRUE(locking_warnings(body_of<SpringMassSpec>(0.49)).empty()) << "springs have a Poisson's ratio of their own";
}

TEST(LockingWarning, IsSilentOnceTheSceneTakesTheCureAndHearsMaterialRegions) {
  auto body = body_of<QuasiStaticSpec>(0.3);
  body.materials.push_back({{}, {1e4, 0.4999, 1000}});
  EXPECT_EQ(locking_warnings(body).size(), 1u);
  body.offline = Offline{1, FiniteElement::p1, Formulation::displacement};
  EXPECT_EQ(locking_warnings(body).size(), 1u) << "refined linear elements lock as well";
  body.offline = Offline{1, FiniteElement::p1, Formulation::locking_free};
  EXPECT_TRUE(locking_warnings(body).empty());
  body.offline = Offline{0, FiniteElement::p2, Formulation::displacement};
  EXPECT_TRUE(locking_warnings(body).empty());
}

}  // namespace
}  // namespace palpate

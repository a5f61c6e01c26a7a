#include "common/dynamics/resection.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

// Three tetrahedra on the x axis with legs of 1, 1 and 2 cm, their centroids at x = 0.25, 1.25 and 2.5 cm.
ElasticMesh three_in_a_row() {
  ElasticMesh mesh;
  for (const double leg : {0.01, 0.01, 0.02}) {
    const int first = mesh.nodes();
    const Eigen::Vector3d corner(0.01 * static_cast<double>(mesh.tetrahedra.size()), 0, 0);
    mesh.rest.push_back(corner);
    for (int axis = 0; axis < 3; ++axis) mesh.rest.push_back(corner + leg * Eigen::Vector3d::Unit(axis));
    mesh.tetrahedra.push_back({first, first + 1, first + 2, first + 3});
  }
  return mesh;
}

const Box kBeyondTheFirst{{0.01, -1, -1}, {1, 1, 1}};

TEST(Resection, CountsWhatIsCutInsideAndOutsideOfWhatIsMarked) {
  Resection resection(kBeyondTheFirst, three_in_a_row());
  resection.cut(std::vector<int>{2});
  resection.cut(std::vector<int>{0, 1});
  EXPECT_EQ(resection.inside().tetrahedra, 2u);
  EXPECT_NEAR(resection.inside().volume, 9e-6 / 6, 1e-15);
  EXPECT_EQ(resection.outside().tetrahedra, 1u);
  EXPECT_NEAR(resection.outside().volume, 1e-6 / 6, 1e-15);
}

TEST(Resection, LeavesOutNumbersThatTheBodyDoesNotHave) {
  Resection resection(kBeyondTheFirst, three_in_a_row());
  resection.cut(std::vector<std::uint32_t>{0, 3, 0xffffffff});
  EXPECT_EQ(resection.inside().tetrahedra, 0u);
  EXPECT_EQ(resection.outside().tetrahedra, 1u);
}

}  // namespace
}  // namespace palpate

#include "tools/organ/mesh_distances.hpp"

#include <gtest/gtest.h>

#include "common/mesh/generators.hpp"

namespace palpate {
namespace {

/// A cube of 10 mm beside another, so far from it [m] along x.
struct Cubes {
  explicit Cubes(double apart)
      : first(make_block({0, 0, 0}, {0.01, 0.01, 0.01}, {2, 2, 2})),
        second(make_block({0.01 + apart, 0.003, 0.003}, {0.02 + apart, 0.013, 0.013}, {2, 2, 2})) {}

  std::string told(double gap) const {
    Output out(false);
    ::testing::internal::CaptureStdout();
    tell_distances({{"one", first}, {"two", second}}, gap, out);
    distance = out.figures()["least_distance"]["distance_m"];
    return ::testing::internal::GetCapturedStdout();
  }

  TetMesh first, second;
  mutable double distance = 0;
};

TEST(MeshDistances, TheLeastIsToldAndOneOfLessThanHalfTheGapIsWarnedOf) {
  const Cubes cubes(0.0004);
  const std::string enough = cubes.told(0.0005), close = cubes.told(0.001);
  EXPECT_NEAR(cubes.distance, 0.0004, 1e-9);
  EXPECT_NE(enough.find("least distance between the meshes: 0.4 mm, of 'one' and 'two' at ("), std::string::npos)
      << enough;
  EXPECT_EQ(enough.find("warning"), std::string::npos) << enough;
  EXPECT_NE(close.find("warning: 'one' and 'two' come as near as 0.4 mm at (10, "), std::string::npos) << close;
}

TEST(MeshDistances, MeshesThatCrossAreRefusedWithThePlaceWhereAGapIsAskedFor) {
  const Cubes cubes(-0.0004);
  Output out(true);
  try {
    tell_distances({{"one", cubes.first}, {"two", cubes.second}}, 0.001, out);
    FAIL() << "nothing is said";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("the meshes of 'one' and 'two' cross at ("), std::string::npos)
        << error.what();
  }
  ::testing::internal::CaptureStdout();
  Output told(false);
  tell_distances({{"one", cubes.first}, {"two", cubes.second}}, 0, told);
  EXPECT_NE(::testing::internal::GetCapturedStdout().find("warning: the meshes of 'one' and 'two' cross"),
            std::string::npos);
}

TEST(MeshDistances, AMeshWithinAnotherIsACrossing) {
  const TetMesh outer = make_block({0, 0, 0}, {0.01, 0.01, 0.01}, {2, 2, 2}),
                inner = make_block({0.004, 0.004, 0.004}, {0.006, 0.006, 0.006}, {1, 1, 1});
  Output out(true);
  EXPECT_THROW(tell_distances({{"outer", outer}, {"inner", inner}}, 0.001, out), std::runtime_error);
}

}  // namespace
}  // namespace palpate

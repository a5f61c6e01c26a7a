// What `palpate path` draws.
#include "tools/film/path_picture.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "render_node/image.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/film/path_shape.hpp"

namespace palpate {
namespace {

/// Whether all triangles look away from where `inside` has their middle's nearest inner point.
template <class Inside>
void expect_outward(const PathShape& shape, const Inside& inside) {
  ASSERT_FALSE(shape.triangles.empty());
  for (const auto& [a, b, c] : shape.triangles) {
    const Eigen::Vector3f &p = shape.position[a], &q = shape.position[b], &r = shape.position[c];
    const Eigen::Vector3f normal = (q - p).cross(r - p), middle = (p + q + r) / 3;
    EXPECT_GE(normal.dot(middle - inside(middle)), 0);
    EXPECT_GT(shape.normal[a].dot(p - inside(p)), 0);
  }
}

TEST(PathShape, IsATubeAndBallsSeenFromOutside) {
  const auto on_the_axis = [](const Eigen::Vector3f& p) { return Eigen::Vector3f(0, 0, p.z()); };
  const PathShape tube = tube_along({{0, 0, 0}, {0, 0, 0.01f}, {0, 0, 0.02f}}, 0.001f);
  expect_outward(tube, on_the_axis);
  for (const Eigen::Vector3f& p : tube.position) EXPECT_NEAR((p - on_the_axis(p)).norm(), 0.001f, 1e-7f);
  const Eigen::Vector3f centre(0.1f, 0, 0);
  expect_outward(balls_at({centre}, 0.002f), [&](const Eigen::Vector3f&) { return centre; });
}

TEST(PathPicture, ShowsTheWayAndWhereTheTipStands) {
  const testing::OwnFolder folder("path");
  const std::string scenes = PALPATE_SOURCE "/scenes/", picture = (folder / "path.png").string();
  draw_path({scenes + "liver.toml", scenes + "trajectories/liver_probe.csv", picture, {}});
  const Image image = read_png(picture);
  int way = 0, stands = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* const rgb = image.pixel(x, y);
      way += rgb[0] > 150 && rgb[1] > 120 && rgb[2] < 100;
      stands += rgb[2] > 150 && rgb[0] < 100;
    }
  EXPECT_GT(way, 200);
  EXPECT_GT(stands, 100);
}

}  // namespace
}  // namespace palpate

#include "common/geometry/buckets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "tests/contact/moving_surface.hpp"
#include "tests/tool/count_allocations.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 2>;

std::vector<int> ask(const Buckets& buckets, const MovingSurface& surface, const Corners& box, double radius = 0) {
  std::vector<int> found(surface.size());
  found.resize(buckets.query(box[0], box[1], radius, found));
  std::sort(found.begin(), found.end());
  return found;
}

Corners random_box(MovingSurface& surface) {
  const Vector3d centre = surface.uniform(0, 0.12) * surface.direction();
  const Vector3d half = Vector3d::Constant(std::pow(10.0, surface.uniform(-5, -1)));
  return {centre - half, centre + half};
}

void enter_all(Buckets& buckets, const MovingSurface& surface) {
  for (int t = 0; t < surface.size(); ++t) {
    const Corners box = swept_box(surface.before(t), surface.after(t));
    buckets.move(t, box[0], box[1]);
  }
}

TEST(Buckets, GiveEveryTriangleWhoseBoxMeetsTheQuestionOnce) {
  MovingSurface surface(1);
  Buckets buckets(surface.rest, surface.triangles, 0.008);
  int far_fewer = 0;
  for (int round = 0; round < 20; ++round) {
    surface.step(0.002);
    enter_all(buckets, surface);
    for (int trial = 0; trial < 100; ++trial) {
      const Corners box = random_box(surface);
      const std::vector<int> found = ask(buckets, surface, box);
      EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
      for (int t = 0; t < surface.size(); ++t) {
        if (!meet(swept_box(surface.before(t), surface.after(t)), box)) continue;
        ASSERT_TRUE(std::binary_search(found.begin(), found.end(), t)) << "lost triangle " << t;
      }
      far_fewer += 4 * found.size() < surface.triangles.size();
    }
  }
  EXPECT_GT(far_fewer, 1000) << "buckets that always give everything are of no use";
  EXPECT_EQ(buckets.overflow(), 0);
}

TEST(Buckets, GiveEveryTriangleWhoseBoxComesWithinTheRadius) {
  MovingSurface surface(11);
  Buckets buckets(surface.rest, surface.triangles, 0.008);
  enter_all(buckets, surface);
  std::size_t round_ones = 0, square_ones = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Corners box = random_box(surface);
    const double radius = std::pow(10.0, surface.uniform(-4, 0.5));
    const std::vector<int> found = ask(buckets, surface, box, radius);
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    for (int t = 0; t < surface.size(); ++t) {
      const Corners own = swept_box(surface.before(t), surface.after(t));
      const Vector3d apart = (own[0] - box[1]).cwiseMax(box[0] - own[1]).cwiseMax(0.0);
      if (apart.norm() > radius) continue;
      ASSERT_TRUE(std::binary_search(found.begin(), found.end(), t))
          << "lost triangle " << t << " at radius " << radius;
    }
    round_ones += found.size();
    square_ones += ask(buckets, surface, {box[0].array() - radius, box[1].array() + radius}).size();
  }
  EXPECT_LT(round_ones, square_ones) << "the corners of the box are asked too";
}

Segment random_segment(MovingSurface& surface, int trial) {
  const Vector3d start = surface.uniform(0, 0.3) * surface.direction();
  Vector3d way = std::pow(10.0, surface.uniform(-3, 0)) * surface.direction();
  if (trial % 4 == 1) way[trial % 3] = 0;
  if (trial % 4 == 2) way = way.norm() * Vector3d::Unit(trial % 3);
  if (trial % 16 == 3) way.setZero();
  return {start, start + way};
}

// By places along it, close enough to one another that none is between two of them.
bool comes_within(double radius, const Segment& segment, const Corners& box) {
  constexpr int kPlaces = 400;
  for (int i = 0; i <= kPlaces; ++i) {
    const Vector3d p = segment.at(static_cast<double>(i) / kPlaces);
    if ((box[0] - p).cwiseMax(p - box[1]).cwiseMax(0.0).squaredNorm() <= radius * radius) return true;
  }
  return false;
}

TEST(Buckets, GiveEveryTriangleWhoseBoxComesWithinTheRadiusOfASegment) {
  MovingSurface surface(13);
  Buckets buckets(surface.rest, surface.triangles, 0.008);
  enter_all(buckets, surface);
  std::size_t along = 0, in_box = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Segment segment = random_segment(surface, trial);
    const double radius = std::pow(10.0, surface.uniform(-4, -2));
    std::vector<int> found(surface.size());
    found.resize(buckets.query(segment, radius, found));
    std::sort(found.begin(), found.end());
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    for (int t = 0; t < surface.size(); ++t) {
      if (!comes_within(radius, segment, swept_box(surface.before(t), surface.after(t)))) continue;
      ASSERT_TRUE(std::binary_search(found.begin(), found.end(), t)) << "lost triangle " << t << " in trial " << trial;
    }
    along += found.size();
    in_box += ask(buckets, surface, {segment.start.cwiseMin(segment.end), segment.start.cwiseMax(segment.end)}, radius)
                  .size();
  }
  EXPECT_GT(along, 0u);
  EXPECT_LT(2 * along, in_box) << "the corners of a slanting segment's box are asked too";
}

TEST(Buckets, AnswerTheSameWhateverTheHistoryOfMoves) {
  MovingSurface surface(2);
  Buckets used(surface.rest, surface.triangles, 0.006), fresh(surface.rest, surface.triangles, 0.006);
  for (int round = 0; round < 100; ++round) {
    surface.step(0.004);
    enter_all(used, surface);
  }
  enter_all(fresh, surface);
  for (int trial = 0; trial < 500; ++trial) {
    const Corners box = random_box(surface);
    EXPECT_EQ(ask(used, surface, box), ask(fresh, surface, box));
  }
}

TEST(Buckets, LoseNothingWhenTrianglesOutgrowThem) {
  MovingSurface surface(3);
  Buckets buckets(surface.rest, surface.triangles, 0.004);
  for (int t = 0; t < surface.size(); ++t) buckets.move(t, Vector3d(-1, -1, -1), Vector3d(1, 1, 1));
  EXPECT_EQ(buckets.overflow(), surface.size());
  EXPECT_EQ(ask(buckets, surface, random_box(surface)).size(), surface.triangles.size());
  enter_all(buckets, surface);
  EXPECT_EQ(buckets.overflow(), 0);
}

TEST(Buckets, LoseNothingWhenEntriesRunOut) {
  MovingSurface surface(3);
  Buckets buckets(surface.rest, surface.triangles, 0.01);
  for (int t = 0; t < surface.size(); ++t) buckets.move(t, Vector3d::Constant(-0.01475), Vector3d::Constant(0.01475));
  EXPECT_GT(buckets.overflow(), 0);
  EXPECT_LT(buckets.overflow(), surface.size());
  EXPECT_EQ(ask(buckets, surface, {Vector3d::Constant(-0.001), Vector3d::Constant(0.001)}).size(),
            surface.triangles.size());
  enter_all(buckets, surface);
  EXPECT_EQ(buckets.overflow(), 0);
}

TEST(Buckets, EnterWhatLiesBeyondTheGridInItsOutermostBuckets) {
  MovingSurface surface(4);
  Buckets buckets(surface.rest, surface.triangles, 0.01);
  buckets.move(7, Vector3d(5, 5, 5), Vector3d(5.01, 5.01, 5.01));
  const auto found = ask(buckets, surface, {Vector3d(7, 7, 7), Vector3d(8, 8, 8)});
  EXPECT_EQ(found, std::vector<int>{7});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  buckets.move(8, Vector3d(nan, nan, nan), Vector3d(nan, nan, nan));
  const auto near = ask(buckets, surface, {Vector3d(-1, -1, -1), Vector3d(-0.9, -0.9, -0.9)});
  EXPECT_EQ(near, std::vector<int>{8});
}

TEST(Buckets, ForgetATriangleUntilItIsEnteredAgain) {
  MovingSurface surface(12);
  Buckets whole(surface.rest, surface.triangles, 0.008);
  Buckets comers(surface.rest, 0.008, surface.size(), 8 * surface.triangles.size());
  EXPECT_TRUE(ask(comers, surface, {Vector3d::Constant(-1), Vector3d::Constant(1)}).empty());
  std::vector<char> in(surface.size(), 0);
  for (int round = 0; round < 40; ++round) {
    surface.step(0.002);
    enter_all(whole, surface);
    for (int t = 0; t < surface.size(); ++t) {
      in[t] = surface.pick(3) > 0;
      const Corners box = swept_box(surface.before(t), surface.after(t));
      if (in[t])
        comers.move(t, box[0], box[1]);
      else
        comers.remove(t);
    }
    for (int trial = 0; trial < 20; ++trial) {
      const Corners box = random_box(surface);
      std::vector<int> expected = ask(whole, surface, box);
      std::erase_if(expected, [&](int t) { return !in[t]; });
      ASSERT_EQ(ask(comers, surface, box), expected);
    }
  }
  EXPECT_EQ(comers.overflow(), 0);
}

TEST(Buckets, TakeNoMemoryAfterConstruction) {
  MovingSurface surface(5);
  Buckets buckets(surface.rest, surface.triangles, 0.005);
  std::vector<int> found(surface.size());
  surface.step(0.01);
  const long before = allocations();
  enter_all(buckets, surface);
  buckets.remove(3);
  buckets.move(3, Vector3d(-1, -1, -1), Vector3d(1, 1, 1));
  const int count = buckets.query(Vector3d(-1, -1, -1), Vector3d(1, 1, 1), 0, found);
  EXPECT_EQ(allocations() - before, 0);
  EXPECT_EQ(count, surface.size());
}

TEST(Buckets, RefuseASizeThatDoesNotSuit) {
  const MovingSurface surface(6);
  for (const double size : {0.0, -0.01, 1e-6, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(Buckets(surface.rest, surface.triangles, size), std::runtime_error) << size;
}

}  // namespace
}  // namespace palpate

#include "tools/film/path_shape.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate {
namespace {

using Eigen::Vector3f;

constexpr int kAround = 12, kRings = 9;

/// A ring of vertices about a centre, joined to the one before it if that is of the same tube or ball.
void add_ring(PathShape& shape, const Vector3f& centre, const Vector3f& x, const Vector3f& y, float radius,
              const Vector3f& along, bool joined) {
  const int first = static_cast<int>(shape.position.size());
  for (int j = 0; j < kAround; ++j) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(j) / kAround;
    const Vector3f out = std::cos(angle) * x + std::sin(angle) * y;
    shape.position.push_back(centre + radius * out);
    shape.normal.push_back((out + along).normalized());
  }
  for (int j = 0; joined && j < kAround; ++j) {
    const int a = first - kAround + j, b = first - kAround + (j + 1) % kAround;
    shape.triangles.push_back({a, b, b + kAround});
    shape.triangles.push_back({a, b + kAround, a + kAround});
  }
}

}  // namespace

PathShape tube_along(const std::vector<Vector3f>& points, float radius) {
  PathShape shape;
  Vector3f x = Vector3f::UnitX();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3f chord = points[std::min(i + 1, points.size() - 1)] - points[i == 0 ? 0 : i - 1];
    if (chord.isZero()) continue;
    const Vector3f along = chord.normalized();
    const Vector3f across = x - x.dot(along) * along;  // as the ring before, not twisted
    x = across.norm() > 0.1f ? across.normalized() : along.unitOrthogonal();
    add_ring(shape, points[i], x, along.cross(x), radius, Vector3f::Zero(), !shape.position.empty());
  }
  return shape;
}

PathShape balls_at(const std::vector<Vector3f>& points, float radius) {
  PathShape shape;
  for (const Vector3f& point : points)
    for (int i = 0; i <= kRings; ++i) {
      const float angle = std::numbers::pi_v<float> * (static_cast<float>(i) / kRings - 0.5f);
      const Vector3f up = std::sin(angle) * Vector3f::UnitZ();
      const float round = std::max(std::cos(angle), 1e-3f);
      add_ring(shape, point + radius * up, Vector3f::UnitX(), Vector3f::UnitY(), radius * round, up / round, i > 0);
    }
  return shape;
}

}  // namespace palpate

#include "common/contact/patch/patch_grid.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

using Eigen::Vector2d;

constexpr double kSquaresPerRadius = 4;  // 44 squares in all
constexpr double kWidth = 0.95;          // of the radius: beyond it the sphere is too steep to press

}  // namespace

PatchGrid::PatchGrid(double radius, const HalfSpace& half_space) : radius_(radius), edge_(radius / kSquaresPerRadius) {
  const int side = static_cast<int>(2 * kWidth * kSquaresPerRadius);
  for (int i = 0; i <= side; ++i)
    for (int j = 0; j <= side; ++j) {
      const Vector2d at = edge_ * Vector2d(i - 0.5 * side, j - 0.5 * side);
      if (at.norm() < kWidth * radius) middle_.push_back(at);
    }
  for (const Vector2d& at : middle_) rise_.push_back(std::sqrt(radius * radius - at.squaredNorm()));
  const double per_force = 1 / (edge_ * edge_);
  for (const Vector2d& p : middle_)
    for (const Vector2d& q : middle_) {
      const Vector2d d = p - q;
      pressed_.push_back(per_force * half_space.pressed(d.x(), d.y(), edge_));
      sheared_.push_back(per_force * half_space.sheared(d.x(), d.y(), edge_));
    }
}

const PatchGrid& PatchGrids::of(double radius) {
  const auto known = std::ranges::find(grids_, radius, [](const auto& g) { return g->radius(); });
  return known != grids_.end() ? **known : *grids_.emplace_back(std::make_unique<PatchGrid>(radius, half_space_));
}

}  // namespace palpate

#pragma once
#include <Eigen/Core>
#include <array>

namespace palpate {

/// A piece of a plane by its moments, which add up.
struct PlanePiece {
  double area = 0;                                  ///< [m^2]
  Eigen::Vector2d first = Eigen::Vector2d::Zero();  ///< [m^3] of its area

  Eigen::Vector2d middle() const { return first / area; }
  PlanePiece operator*(double share) const { return {share * area, share * first}; }
  void operator+=(const PlanePiece& other) {
    area += other.area;
    first += other.first;
  }
};

/// What of a triangle, whichever way round, lies within a square about `middle`; `half` [m]: of its side.
PlanePiece piece_within(const std::array<Eigen::Vector2d, 3>& triangle, const Eigen::Vector2d& middle, double half);

}  // namespace palpate

#pragma once
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "common/contact/patch/half_space.hpp"

namespace palpate {

/// The squares of a sphere's patch: their middles about the patch's own, and what the half-space makes of them. The
/// same for all patches of one radius on one material.
class PatchGrid {
 public:
  PatchGrid(double radius, const HalfSpace& half_space);

  int size() const { return static_cast<int>(middle_.size()); }
  double radius() const { return radius_; }                                ///< [m] of the sphere
  double edge() const { return edge_; }                                    ///< [m] of a square
  const Eigen::Vector2d& middle(int p) const { return middle_[p]; }        ///< [m]
  double rise(int p) const { return rise_[p]; }                            ///< [m] of the sphere's middle over it there
  double pressed(int p, int q) const { return pressed_[size() * p + q]; }  ///< [m/N]
  const Eigen::Matrix2d& sheared(int p, int q) const { return sheared_[size() * p + q]; }  ///< [m/N]

 private:
  double radius_, edge_;
  std::vector<Eigen::Vector2d> middle_;
  std::vector<double> rise_, pressed_;
  std::vector<Eigen::Matrix2d> sheared_;
};

/// One grid for each radius, on one material.
class PatchGrids {
 public:
  explicit PatchGrids(const HalfSpace& half_space) : half_space_(half_space) {}
  /// Stays where it is while this object lives.
  const PatchGrid& of(double radius);

 private:
  HalfSpace half_space_;
  std::vector<std::unique_ptr<PatchGrid>> grids_;
};

}  // namespace palpate

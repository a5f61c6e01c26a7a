#include "tools/organ/active_contour.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr int kMaxSteps = 40, kFewestPoints = 8;  // points of a contour that is moved
constexpr double kStill = 0.02;                   // [voxels] that no point moves further in the last step
constexpr double kSample = 0.25;                  // [voxels] along the normal
constexpr double kAcross = 1;                     // [voxels] to both sides of an edge
constexpr double kOfNoise = 5;                    // deviations of the organ's grey that an edge rises by
constexpr double kHeld = 0.05;                    // pull of a point to where it is, beside that of an edge

/// Grey values of one slice, between voxels evenly.
class Slice {
 public:
  Slice(const ScalarGrid& grey, int k)
      : width_(grey.shape.count[0]), height_(grey.shape.count[1]), value_(&grey.value[grey.shape.index(0, 0, k)]) {}

  double at(double x, double y) const {
    x = std::clamp(x, 0.0, width_ - 1.0), y = std::clamp(y, 0.0, height_ - 1.0);
    const int i = std::min(static_cast<int>(x), std::max(width_ - 2, 0));
    const int j = std::min(static_cast<int>(y), std::max(height_ - 2, 0));
    const int right = width_ > 1, down = height_ > 1 ? width_ : 0;
    const float* v = value_ + static_cast<std::size_t>(j) * width_ + i;
    const double upper = v[0] + (x - i) * (v[right] - v[0]), lower = v[down] + (x - i) * (v[down + right] - v[down]);
    return upper + (y - j) * (lower - upper);
  }

 private:
  int width_, height_;
  const float* value_;
};

struct Edge {
  double at = 0;  ///< [voxels] along the outward normal
  bool found = false;
};

/// The steepest rise of the difference to the organ's grey, nearer ones before those that are as steep.
Edge edge_along(const Slice& slice, const Eigen::Vector2d& x, const Eigen::Vector2d& step, const GreyLevel& level,
                double reach) {
  const auto off = [&](double s) {
    const Eigen::Vector2d p = x + s * step;
    return std::abs(slice.at(p.x(), p.y()) - level.median);
  };
  const int samples = static_cast<int>(reach / kSample);
  Edge best;
  double steepest = kOfNoise * level.deviation;
  for (int i = -samples; i <= samples; ++i) {
    const double s = i * kSample, rise = off(s + kAcross) - off(s - kAcross);
    const double counted = rise * (1 - 0.3 * std::abs(s) / reach);
    if (counted <= steepest) continue;
    steepest = counted;
    best = {s, true};
  }
  return best;
}

/// Minimises pull (x - target)^2 + stiffness |x'' |^2 over a closed line of even points.
class LineBending {
 public:
  explicit LineBending(double stiffness) : stiffness_(stiffness) {}

  Eigen::MatrixX2d solve(const Eigen::VectorXd& pull, const Eigen::MatrixX2d& target) {
    const int n = static_cast<int>(pull.size());
    std::vector<Eigen::Triplet<double>> entries;
    constexpr double kStencil[]{1, -4, 6, -4, 1};
    for (int i = 0; i < n; ++i) {
      entries.emplace_back(i, i, pull[i]);
      for (int d = -2; d <= 2; ++d) entries.emplace_back(i, (i + d + n) % n, stiffness_ * kStencil[d + 2]);
    }
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    solver_.compute(matrix);
    return solver_.solve(pull.asDiagonal() * target);
  }

 private:
  double stiffness_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

/// Outward unit normal in the slice's plane, as a step in voxels.
Eigen::Vector2d normal_step(const Contour& line, std::size_t n, const Eigen::Array2d& voxel) {
  const Eigen::Array2d along =
      (line[(n + 1) % line.size()] - line[(n + line.size() - 1) % line.size()]).array() * voxel;
  const Eigen::Array2d normal(along.y(), -along.x());
  const double length = normal.matrix().norm();
  return length > 0 ? Eigen::Vector2d(normal / length / voxel) : Eigen::Vector2d::Zero();
}

}  // namespace

MovedContour move_to_edges(const Contour& start, const ScalarGrid& grey, int k, const GreyLevel& level,
                           const ContourForces& forces) {
  const Slice slice(grey, k);
  const Eigen::Array2d voxel = grey.shape.spacing.head<2>().array() / grey.shape.spacing.head<2>().minCoeff();
  LineBending bending(forces.stiffness);
  const Contour first = resampled(start, 1);
  MovedContour moved{first};
  double furthest = forces.reach;
  for (int step = 0; step < kMaxSteps && furthest > kStill && moved.line.size() >= kFewestPoints; ++step) {
    const int n = static_cast<int>(moved.line.size());
    Eigen::VectorXd pull = Eigen::VectorXd::Constant(n, kHeld);
    Eigen::MatrixX2d target(n, 2);
    for (int i = 0; i < n; ++i) {
      const Eigen::Vector2d outward = normal_step(moved.line, i, voxel);
      const Edge edge = edge_along(slice, moved.line[i], outward, level, forces.reach);
      if (edge.found) pull[i] = 1;
      const Eigen::Vector2d away = moved.line[i] + edge.at * outward - first[i];
      target.row(i) = first[i] + std::min(1.0, forces.reach / std::max(away.norm(), 1e-9)) * away;
    }
    moved.on_edge = static_cast<double>((pull.array() == 1).count()) / n;
    const Eigen::MatrixX2d x = bending.solve(pull, target);
    furthest = 0;
    for (int i = 0; i < n; ++i) {
      furthest = std::max(furthest, (x.row(i).transpose() - moved.line[i]).norm());
      moved.line[i] = x.row(i);
    }
  }
  return moved;
}

}  // namespace palpate

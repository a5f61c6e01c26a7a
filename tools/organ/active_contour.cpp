#include "tools/organ/active_contour.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate {
namespace {

constexpr int kMaxSteps = 40, kFewestPoints = 8;  // points of a contour that is moved
constexpr double kStill = 0.02;                   // [voxels] that no point moves further in the last step
constexpr double kSample = 0.25;                  // [voxels] along the normal
constexpr double kAcross = 1;                     // [voxels] to both sides of an edge
constexpr double kOfNoise = 5;                    // deviations of the organ's grey that an edge rises by
constexpr double kHeld = 0.05;                    // pull of a point to where it started, beside that of an edge

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

/// The steepest change that leads outward away from the organ's grey, nearer ones before those that are as steep.
Edge edge_along(const Slice& slice, const Eigen::Vector2d& x, const Eigen::Vector2d& step, const GreyLevel& level,
                double reach) {
  const auto off = [&](double s) {
    const Eigen::Vector2d p = x + s * step;
    return slice.at(p.x(), p.y()) - level.median;
  };
  const auto counted = [&](double s) {
    const double inner = off(s - kAcross), outer = off(s + kAcross), far = s / reach;
    return std::abs(outer) > std::abs(inner) ? std::abs(outer - inner) * (1 - 0.3 * far * far) : 0;
  };
  const int samples = static_cast<int>(reach / kSample);
  Edge best;
  double steepest = kOfNoise * level.deviation;
  for (int i = -samples; i <= samples; ++i) {
    const double rise = counted(i * kSample);
    if (rise <= steepest) continue;
    steepest = rise;
    best = {i * kSample, true};
  }
  if (!best.found) return best;
  const double before = counted(best.at - kSample), after = counted(best.at + kSample);
  const double bend = before - 2 * steepest + after;  // of the parabola through the three
  if (bend < 0) best.at += kSample * std::clamp(0.5 * (before - after) / bend, -1.0, 1.0);
  return best;
}

/// Minimises pull (x - target)^2 + stiffness |x'' - that of an ellipse|^2 over a closed line of even points; so that a
/// line without edges does not shrink.
class LineBending {
 public:
  explicit LineBending(double stiffness) : stiffness_(stiffness) {}

  Eigen::MatrixX2d solve(const Eigen::VectorXd& pull, const Eigen::MatrixX2d& target) {
    const int n = static_cast<int>(pull.size());
    const double turn = std::cos(2 * std::numbers::pi / n);  // x[i-1] - 2 turn x[i] + x[i+1] is 0 of an ellipse
    const double stencil[]{1, -4 * turn, 2 + 4 * turn * turn, -4 * turn, 1};
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i) {
      entries.emplace_back(i, i, pull[i]);
      for (int d = -2; d <= 2; ++d) entries.emplace_back(i, (i + d + n) % n, stiffness_ * stencil[d + 2]);
    }
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    solver_.compute(matrix);
    const Eigen::RowVector2d middle = target.colwise().mean();
    const Eigen::MatrixX2d around = solver_.solve(pull.asDiagonal() * (target.rowwise() - middle));
    return around.rowwise() + middle;
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
      target.row(i) = first[i];
      if (!edge.found) continue;
      pull[i] = 1;
      const Eigen::Vector2d away = moved.line[i] + edge.at * outward - first[i];
      target.row(i) += std::min(1.0, forces.reach / std::max(away.norm(), 1e-9)) * away;
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

#include "common/mesh/surface_change.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector3d;
using EdgePair = Eigen::Matrix<double, 3, 2>;

EdgePair edges_of(const std::array<Vector3d, 3>& corners) {
  EdgePair edges;
  edges << corners[1] - corners[0], corners[2] - corners[0];
  return edges;
}

Vector3d normal_of(const EdgePair& edges) {
  return edges.col(0).cross(edges.col(1)).normalized();
}

}  // namespace

double SurfaceAtRest::six_volumes(const std::array<Vector3d, 3>& corners) {
  return corners[0].dot(corners[1].cross(corners[2]));
}

SurfaceAtRest::SurfaceAtRest(const std::vector<Vector3d>& position, std::vector<std::array<int, 3>> triangles)
    : triangles_(std::move(triangles)) {
  for (const auto& [a, b, c] : triangles_) {
    const std::array corners{position[a], position[b], position[c]};
    const EdgePair edges = edges_of(corners);
    Frame frame;
    frame.normal = normal_of(edges);
    frame.tangent << edges.col(0).normalized(), frame.normal.cross(edges.col(0).normalized());
    frame.from_edges = (frame.tangent.transpose() * edges).inverse();
    frames_.push_back(frame);
    six_volumes_ += six_volumes(corners);
  }
}

// F = E' E^-1 in the triangle's plane; U = sqrt(F^T F) = (C + sqrt(det C) I) / sqrt(tr C + 2 sqrt(det C)), and R = F
// U^-1.
SurfaceChange SurfaceAtRest::change(std::span<const Eigen::Vector3f> position) const {
  double largest = 1, least = 1, cosine = 1, sum = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [a, b, c] = triangles_[t];
    const std::array<Vector3d, 3> corners{position[a].cast<double>(), position[b].cast<double>(),
                                          position[c].cast<double>()};
    sum += six_volumes(corners);
    const EdgePair edges = edges_of(corners), gradient = edges * frames_[t].from_edges;
    const Matrix2d square = gradient.transpose() * gradient;
    const double area = std::sqrt(std::max(0.0, square.determinant())), trace = square.trace() + 2 * area;
    const double apart = std::sqrt(std::max(0.0, square.trace() - 2 * area)), together = std::sqrt(trace);
    largest = std::max(largest, 0.5 * (together + apart));
    least = std::min(least, 0.5 * (together - apart));
    if (!(area > 0)) continue;
    const Matrix2d stretch = (square + area * Matrix2d::Identity()) / together;
    const EdgePair turned = gradient * stretch.inverse();
    const double diagonal =
        (turned.array() * frames_[t].tangent.array()).sum() + normal_of(edges).dot(frames_[t].normal);
    cosine = std::min(cosine, 0.5 * (diagonal - 1));
  }
  return {std::max(largest, 1 / std::max(least, 1e-9)) - 1, std::acos(std::clamp(cosine, -1.0, 1.0)),
          sum / six_volumes_ - 1};
}

}  // namespace palpate

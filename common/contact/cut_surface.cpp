#include "common/contact/cut_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <limits>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kSlackOfBucket = 0.1;
constexpr int kEntriesPerFacet = 8;

Vector3d area_vector(const Triangle& c) {
  return (c[1] - c[0]).cross(c[2] - c[0]);
}

// A closed surface has about two facets to a node.
std::size_t entries_for(const CutMesh& mesh) {
  return kEntriesPerFacet * std::max(mesh.visible().size(), 2 * static_cast<std::size_t>(mesh.nodes()));
}

}  // namespace

CutSurface::CutSurface(const CutMesh& mesh, std::span<const Vector3d> rest, double bucket_size)
    : mesh_(mesh),
      position_(rest.begin(), rest.end()),
      previous_(position_),
      buckets_(rest, bucket_size, 4 * mesh.size(), entries_for(mesh)),
      slack_(kSlackOfBucket * bucket_size),
      box_(rest.size(), {Vector3d::Constant(1), Vector3d::Constant(-1)}),
      facets_of_node_(rest.size(), 0),
      entered_in_(4 * static_cast<std::size_t>(mesh.size()), 0),
      found_(4 * static_cast<std::size_t>(mesh.size())) {
  assert(static_cast<int>(rest.size()) == mesh.nodes());
  leavers_.reserve(rest.size());
  for (int facet : mesh.visible())
    for (int node : mesh.facet(facet))
      if (facets_of_node_[node]++ == 0) stand(node);
  for (int facet : mesh.visible()) enter(facet);
  find_bounds();
}

// The previous position needs no question: it was the present one when the box was last found to fit.
bool CutSurface::fits(int node) const {
  const auto& [low, high] = box_[node];
  const Vector3d &x = position_[node], &before = previous_[node];
  const bool inside = (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
  return inside && ((high - low) - (x - before).cwiseAbs()).maxCoeff() <= 6 * slack_;
}

void CutSurface::stand(int node) {
  box_[node] = {previous_[node].cwiseMin(position_[node]).array() - slack_,
                previous_[node].cwiseMax(position_[node]).array() + slack_};
}

void CutSurface::enter(int facet) {
  const auto [a, b, c] = mesh_.facet(facet);
  buckets_.move(facet, box_[a][0].cwiseMin(box_[b][0]).cwiseMin(box_[c][0]),
                box_[a][1].cwiseMax(box_[b][1]).cwiseMax(box_[c][1]));
}

void CutSurface::set_positions(std::span<const Vector3d> positions) {
  assert(positions.size() == position_.size());
  position_.swap(previous_);
  std::copy(positions.begin(), positions.end(), position_.begin());
  leavers_.clear();
  for (int node = 0; node < mesh_.nodes(); ++node) {
    if (!on_surface(node) || fits(node)) continue;
    stand(node);
    leavers_.push_back(node);
  }
  find_bounds();
  ++step_;
  const auto enter_once = [&](int facet) {
    if (entered_in_[facet] == step_) return;
    entered_in_[facet] = step_;
    enter(facet);
  };
  for (int node : leavers_) for_each_facet_of(node, enter_once);
}

// Of everything that is or may come to the surface, on its way from the previous to the present positions.
void CutSurface::find_bounds() {
  low_.setConstant(std::numeric_limits<double>::infinity());
  high_ = -low_;
  for (int node = 0; node < mesh_.nodes(); ++node) {
    if (!mesh_.has_node(node)) continue;
    low_ = low_.cwiseMin(position_[node]).cwiseMin(previous_[node]);
    high_ = high_.cwiseMax(position_[node]).cwiseMax(previous_[node]);
  }
}

void CutSurface::follow() {
  for (int facet : mesh_.vanished()) {
    buckets_.remove(facet);
    for (int node : mesh_.facet(facet)) --facets_of_node_[node];
  }
  for (int facet : mesh_.appeared())
    for (int node : mesh_.facet(facet))
      if (facets_of_node_[node]++ == 0) stand(node);
  for (int facet : mesh_.appeared()) enter(facet);
}

std::span<const int> CutSurface::find(const Vector3d& a, const Vector3d& b, double radius) const {
  const Vector3d low = a.cwiseMin(b), high = a.cwiseMax(b);
  if ((low_ - high).cwiseMax(low - high_).maxCoeff() > radius) return {};
  const int candidates = buckets_.query(low, high, radius, found_);
  // The buckets' answer depends on when boxes were entered; the positions do not, and replay needs that.
  int kept = 0;
  for (int i = 0; i < candidates; ++i) {
    const Triangle x = corners(found_[i]), before = previous_corners(found_[i]);
    Vector3d box_low = x[0].cwiseMin(before[0]), box_high = x[0].cwiseMax(before[0]);
    for (int v = 1; v < 3; ++v) {
      box_low = box_low.cwiseMin(x[v]).cwiseMin(before[v]);
      box_high = box_high.cwiseMax(x[v]).cwiseMax(before[v]);
    }
    const Vector3d apart = (box_low - high).cwiseMax(low - box_high).cwiseMax(0.0);
    if (apart.squaredNorm() <= radius * radius) found_[kept++] = found_[i];
  }
  std::sort(found_.begin(), found_.begin() + kept);
  return std::span(found_).first(kept);
}

Vector3d CutSurface::normal(int facet) const {
  return area_vector(corners(facet)).normalized();  // zero stays zero
}

Vector3d CutSurface::vertex_normal(int node) const {
  Vector3d sum = Vector3d::Zero();
  for_each_facet_of(node, [&](int facet) { sum += area_vector(corners(facet)); });
  return sum.normalized();
}

}  // namespace palpate

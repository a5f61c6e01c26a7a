#include "common/contact/cut_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kSlackOfBucket = 0.1;
constexpr int kEntriesPerFacet = 8;

std::vector<std::array<int, 3>> facets_of(const CutMesh& mesh) {
  std::vector<std::array<int, 3>> facets;
  for (int facet = 0; facet < 4 * mesh.size(); ++facet) facets.push_back(mesh.facet(facet));
  return facets;
}

// A closed surface has about two facets to a node.
std::size_t entries_for(const CutMesh& mesh) {
  return kEntriesPerFacet * std::max(mesh.visible().size(), 2 * static_cast<std::size_t>(mesh.nodes()));
}

}  // namespace

CutSurface::CutSurface(const CutMesh& mesh, std::span<const Vector3d> rest, double bucket_size)
    : ContactSurface(rest, facets_of(mesh)),
      mesh_(mesh),
      buckets_(rest, bucket_size, 4 * mesh.size(), entries_for(mesh)),
      slack_(kSlackOfBucket * bucket_size),
      box_(rest.size(), {Vector3d::Constant(1), Vector3d::Constant(-1)}),
      facets_of_node_(rest.size(), 0),
      entered_in_(4 * static_cast<std::size_t>(mesh.size()), 0),
      hidden_(4 * static_cast<std::size_t>(mesh.size()), 0),
      found_(4 * static_cast<std::size_t>(mesh.size())) {
  assert(static_cast<int>(rest.size()) == mesh.nodes());
  leavers_.reserve(rest.size());
  placed_.reserve(rest.size());
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

void CutSurface::state(State& s) {
  std::vector<Vector3d> previous = previous_, present = position_;
  for (std::vector<Vector3d>* positions : {&previous, &present}) {
    s.same(positions->size());
    s.all(*positions);
    if (s.restoring()) set_positions(*positions);
  }
}

void CutSurface::set_positions(std::span<const Vector3d> positions) {
  assert(positions.size() == position_.size());
  for (const auto& [node, at] : placed_) position_[node] = at;
  placed_.clear();
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

void CutSurface::place(int node, const Vector3d& position) {
  const auto found = std::ranges::find(placed_, node, &std::pair<int, Vector3d>::first);
  if (found == placed_.end()) placed_.emplace_back(node, position_[node]);
  position_[node] = position;
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

void CutSurface::hide(std::span<const int> facets) {
  for (int facet : facets) hidden_[facet] = 1;
}

// Into found_, in no order; returns how many.
int CutSurface::collect(const Vector3d& low, const Vector3d& high, double radius) const {
  if ((low_ - high).cwiseMax(low - high_).maxCoeff() > radius) return 0;
  const int candidates = buckets_.query(low, high, radius, found_);
  // The buckets' answer depends on when boxes were entered; the positions do not, and replay needs that.
  int kept = 0;
  for (int i = 0; i < candidates; ++i) {
    if (hidden_[found_[i]]) continue;
    const auto [box_low, box_high] = swept_box(found_[i]);
    const Vector3d apart = (box_low - high).cwiseMax(low - box_high).cwiseMax(0.0);
    if (apart.squaredNorm() <= radius * radius) found_[kept++] = found_[i];
  }
  std::sort(found_.begin(), found_.begin() + kept);
  return kept;
}

std::span<const int> CutSurface::find(const Vector3d& a, const Vector3d& b, double radius) const {
  return std::span(found_).first(collect(a.cwiseMin(b), a.cwiseMax(b), radius));
}

// All that lies near the box of the segment's way; what is far from the segment itself is left out.
std::span<const int> CutSurface::find(const Segment& before, const Segment& now, double radius) const {
  const Vector3d low = now.start.cwiseMin(now.end).cwiseMin(before.start).cwiseMin(before.end);
  const Vector3d high = now.start.cwiseMax(now.end).cwiseMax(before.start).cwiseMax(before.end);
  const int count = collect(low, high, radius);
  const double motion =
      std::sqrt(std::max((now.start - before.start).squaredNorm(), (now.end - before.end).squaredNorm()));
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const auto [box_low, box_high] = swept_box(found_[i]);
    const Vector3d middle = 0.5 * (box_low + box_high);
    const double farthest = radius + motion + 0.5 * (box_high - box_low).norm();
    if ((nearest_point(now, middle) - middle).squaredNorm() <= farthest * farthest) found_[kept++] = found_[i];
  }
  return std::span(found_).first(kept);
}

Vector3d CutSurface::outer_side(const std::array<int, 3>& n) const {
  return (position_[n[1]] - position_[n[0]]).cross(position_[n[2]] - position_[n[0]]).normalized();
}

int CutSurface::facet_of(const std::array<int, 3>& nodes) const {
  int found = -1;
  for_each_facet_of(nodes[0], [&](int facet) {
    const auto& t = triangle(facet);
    const auto first = std::ranges::find(t, nodes[0]) - t.begin();
    if (t[(first + 1) % 3] == nodes[1] && t[(first + 2) % 3] == nodes[2]) found = facet;
  });
  return found;
}

Vector3d CutSurface::vertex_normal(int node) const {
  Vector3d sum = Vector3d::Zero();
  for_each_facet_of(node, [&](int facet) { sum += triangle_normal(facet); });
  return sum.normalized();  // zero stays zero
}

}  // namespace palpate

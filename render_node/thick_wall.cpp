#include "render_node/thick_wall.hpp"

#include <Eigen/Geometry>
#include <map>
#include <numeric>
#include <utility>

namespace palpate {
namespace {

/// Edges that one triangle has alone: per start its end, in that triangle's direction.
std::map<int, int> border(std::span<const std::array<int, 3>> triangles) {
  std::map<std::pair<int, int>, int> seen;
  for (const auto& t : triangles)
    for (int k = 0; k < 3; ++k) ++seen[{t[k], t[(k + 1) % 3]}];
  std::map<int, int> next;
  for (const auto& [edge, count] : seen)
    if (!seen.contains({edge.second, edge.first})) next[edge.first] = edge.second;
  return next;
}

}  // namespace

ThickWall::ThickWall(std::span<const std::array<int, 3>> triangles, int vertices, double thickness)
    : half_(0.5f * static_cast<float>(thickness)), vertices_(vertices) {
  outer_.triangles.assign(triangles.begin(), triangles.end());
  outer_.from.resize(vertices);
  std::iota(outer_.from.begin(), outer_.from.end(), 0);
  inner_.from = outer_.from;
  for (const auto& [a, b, c] : outer_.triangles) inner_.triangles.push_back({a, c, b});
  add_rims(triangles);
  for (Side* side : {&outer_, &inner_}) {
    side->position.resize(side->from.size());
    side->normal.resize(side->from.size());
  }
}

void ThickWall::add_rims(std::span<const std::array<int, 3>> triangles) {
  const std::map<int, int> next = border(triangles);
  std::map<int, int> before, place;
  for (const auto& [a, b] : next) before[b] = a;
  for (const auto& [a, b] : next) {
    place[a] = vertices_ + 2 * static_cast<int>(rims_.size());
    rims_.push_back({a, before.contains(a) ? before[a] : a, b});
    inner_.from.insert(inner_.from.end(), {a, a});
  }
  for (const auto& [a, b] : next) {
    if (!place.contains(b)) continue;
    const int outer_a = place[a], inner_a = outer_a + 1, outer_b = place[b], inner_b = outer_b + 1;
    inner_.triangles.push_back({outer_b, outer_a, inner_a});
    inner_.triangles.push_back({outer_b, inner_a, inner_b});
  }
}

void ThickWall::place(std::span<const Eigen::Vector3f> position, std::span<const Eigen::Vector3f> normal) {
  for (int v = 0; v < vertices_; ++v) {
    const Eigen::Vector3f offset = half_ * normal[v];
    outer_.position[v] = position[v] + offset;
    outer_.normal[v] = normal[v];
    inner_.position[v] = position[v] - offset;
    inner_.normal[v] = -normal[v];
  }
  int v = vertices_;
  for (const Rim& rim : rims_) {
    const Eigen::Vector3f along = position[rim.after] - position[rim.before];
    const Eigen::Vector3f outward = along.cross(normal[rim.vertex]).normalized();
    inner_.position[v] = outer_.position[rim.vertex];
    inner_.position[v + 1] = inner_.position[rim.vertex];
    inner_.normal[v] = inner_.normal[v + 1] = outward;
    v += 2;
  }
}

}  // namespace palpate

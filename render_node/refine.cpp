#include "render_node/refine.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <unordered_map>

namespace palpate {
Refinement::Refinement(std::span<const std::array<int, 3>> triangles, int vertices, int levels,
                       std::span<const Eigen::Vector3f> rest)
    : coarse_(vertices), crease_(vertices, 0), triangles_(triangles.begin(), triangles.end()) {
  if (!rest.empty()) mark_creases(rest);
  for (int level = 0; level < levels; ++level) split();
}

void Refinement::mark_creases(std::span<const Eigen::Vector3f> rest) {
  const float min_cosine = 0.64f;  // 50 degrees between two faces of a vertex
  std::vector<std::vector<Eigen::Vector3f>> faces(coarse_);
  for (const auto& t : triangles_) {
    const Eigen::Vector3f normal = (rest[t[1]] - rest[t[0]]).cross(rest[t[2]] - rest[t[0]]).normalized();
    for (int v : t) faces[v].push_back(normal);
  }
  for (int v = 0; v < coarse_; ++v)
    for (const Eigen::Vector3f& a : faces[v])
      for (const Eigen::Vector3f& b : faces[v]) crease_[v] |= a.dot(b) < min_cosine;
}

void Refinement::split() {
  std::unordered_map<std::uint64_t, int> middle_of;
  const auto middle = [&](int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    const std::uint64_t key = (static_cast<std::uint64_t>(low) << 32) | static_cast<std::uint32_t>(high);
    const auto [entry, is_new] = middle_of.try_emplace(key, vertices());
    if (is_new) {
      edges_.push_back({low, high});
      crease_.push_back(crease_[low] && crease_[high]);
    }
    return entry->second;
  };
  std::vector<std::array<int, 3>> finer;
  finer.reserve(4 * triangles_.size());
  for (const auto& [a, b, c] : triangles_) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  triangles_ = std::move(finer);
}

void Refinement::apply(std::span<Eigen::Vector3f> position, std::span<Eigen::Vector3f> normal) const {
  int k = coarse_;
  for (const auto& [a, b] : edges_) {
    const Eigen::Vector3f edge = position[b] - position[a];
    const Eigen::Vector3f &na = normal[a], &nb = normal[b];
    if (crease_[a] || crease_[b]) {
      position[k] = 0.5f * (position[a] + position[b]);
      normal[k++] = (na + nb).normalized();
      continue;
    }
    const float rise_a = edge.dot(na), rise_b = -edge.dot(nb);
    position[k] = 0.5f * (position[a] + position[b]) - 0.125f * (rise_a * na + rise_b * nb);
    const float turn = 2 * edge.dot(na + nb) / std::max(edge.squaredNorm(), 1e-20f);
    normal[k] = (na + nb - turn * edge).normalized();
    ++k;
  }
}

void Refinement::apply(std::span<float> scalar) const {
  int k = coarse_;
  for (const auto& [a, b] : edges_) scalar[k++] = 0.5f * (scalar[a] + scalar[b]);
}

int refinement_levels(std::size_t triangles, std::size_t most) {
  int levels = 0;
  while (levels < 2 && 4 * triangles <= most) {
    triangles *= 4;
    ++levels;
  }
  return levels;
}

}  // namespace palpate

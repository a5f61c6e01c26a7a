#include "common/contact/patch/hat_kernel.hpp"

#include <algorithm>
#include <array>

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kIntegrated = 1.5;  // of two nodes' longest edges, up to which their kernel is an integral

using Moments = std::array<std::array<Matrix3d, 3>, 3>;

/// Of the barycentric coordinates' moments those of the nodes' dual functions, 4 L_corner - 1 each, L summing up to 1.
Moments of_duals(const Moments& m) {
  std::array<Matrix3d, 3> row, column;
  for (int p = 0; p < 3; ++p) {
    row[p] = m[p][0] + m[p][1] + m[p][2];
    column[p] = m[0][p] + m[1][p] + m[2][p];
  }
  const Matrix3d all = row[0] + row[1] + row[2];
  Moments duals;
  for (int p = 0; p < 3; ++p)
    for (int q = 0; q < 3; ++q) duals[p][q] = 16 * m[p][q] - 4 * (row[p] + column[q]) + all;
  return duals;
}

std::vector<double> reach_of(const std::vector<bool>& nodes, const SurfaceMap& map) {
  std::vector<double> reach = longest_edges(map);
  for (int n = 0; n < map.size(); ++n) reach[n] = nodes[n] ? kIntegrated * reach[n] : NearPairs::kNone;
  return reach;
}

}  // namespace

HatKernel::HatKernel(const SmoothSurface& surface, const HalfSpace& half_space, const std::vector<bool>& nodes)
    : surface_(surface),
      half_space_(half_space),
      reach_(reach_of(nodes, surface.map())),
      near_(surface.map().position, reach_) {
  integrate();
}

// Pair of triangles by pair of triangles, each once: what they give to the pairs of their corners.
void HatKernel::integrate() {
  const SurfaceMap& map = surface_.map();
  const int count = static_cast<int>(map.triangles.size());
  std::vector<Vector3d> middle;
  std::vector<double> reach;
  for (int t = 0; t < count; ++t) {
    const Triangle c = surface_.corners(t);
    middle.push_back((c[0] + c[1] + c[2]) / 3);
    reach.push_back(NearPairs::kNone);
    for (int v = 0; v < 3; ++v) reach[t] = std::max(reach[t], reach_[map.triangles[t][v]] + (c[v] - middle[t]).norm());
  }
  for_each_near_pair(middle, reach, [&](int s, int t) {
    const auto &of_s = map.triangles[s], &of_t = map.triangles[t];
    const Vector3d &n_s = surface_.facet_normal(s), &n_t = surface_.facet_normal(t);
    if (n_s.dot(n_t) <= 0) return;
    std::array<std::array<Matrix3d*, 3>, 3> blocks;  // of the corners' pairs, null where they are not near
    bool wanted = false;
    for (int p = 0; p < 3; ++p)
      for (int q = 0; q < 3; ++q) {
        blocks[p][q] = near_.find(std::max(of_s[p], of_t[q]), std::min(of_s[p], of_t[q]));
        wanted = wanted || blocks[p][q];
      }
    if (!wanted) return;
    const Moments moments =
        of_duals(kernel_moments(half_space_, surface_.corners(s), surface_.corners(t), (n_s + n_t).normalized()));
    for (int p = 0; p < 3; ++p)
      for (int q = 0; q < 3; ++q) {
        const int i = of_s[p], j = of_t[q];
        if (!blocks[p][q] || (s == t && i < j)) continue;
        Matrix3d sum = moments[p][q] / (surface_.weight(i) * surface_.weight(j));
        if (i == j && s != t) sum += sum.transpose().eval();  // (t, s), the kernel being even
        *blocks[p][q] += i >= j ? sum : Matrix3d(sum.transpose());
      }
  });
}

Matrix3d HatKernel::between(int i, int j) const {
  if (const Matrix3d* block = near_.find(std::max(i, j), std::min(i, j)))
    return i >= j ? *block : Matrix3d(block->transpose());
  return far(surface_, half_space_, i, j);
}

Matrix3d HatKernel::far(const SmoothSurface& surface, const HalfSpace& half_space, int i, int j) {
  const Vector3d &n_i = surface.node_normal(i), &n_j = surface.node_normal(j);
  if (n_i.dot(n_j) <= 0) return Matrix3d::Zero();
  return half_space.at(surface.map().position[i] - surface.map().position[j], (n_i + n_j).normalized());
}

}  // namespace palpate

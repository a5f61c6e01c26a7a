#include "common/mesh/generators.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace palpate {
namespace {

void require(bool condition, const char* sentence) {
  if (!condition) throw std::runtime_error(sentence);
}

double signed_volume(const TetMesh& mesh, const std::array<int, 4>& t) {
  const Eigen::Vector3d& o = mesh.nodes[t[0]];
  return (mesh.nodes[t[1]] - o).cross(mesh.nodes[t[2]] - o).dot(mesh.nodes[t[3]] - o) / 6;
}

void add_positive(TetMesh& mesh, std::array<int, 4> tet) {
  if (signed_volume(mesh, tet) < 0) std::swap(tet[2], tet[3]);
  mesh.tetrahedra.push_back(tet);
}

void check_axis(const std::vector<double>& axis) {
  require(axis.size() >= 2, "a block needs at least one cell along each axis");
  for (std::size_t i = 1; i < axis.size(); ++i) {
    require(std::isfinite(axis[i - 1]) && std::isfinite(axis[i]) && axis[i] > axis[i - 1],
            "the grid coordinates of a block must ascend");
  }
}

std::array<std::vector<double>, 3> even_axes(const Eigen::Vector3d& min, const Eigen::Vector3d& max,
                                             const std::array<int, 3>& cells) {
  std::array<std::vector<double>, 3> axes;
  for (int a = 0; a < 3; ++a) axes[a] = graded_axis(min[a], max[a], cells[a], 1);
  return axes;
}

// Six tetrahedra around the diagonal from corner `start` to the opposite corner: one path along the edges per
// permutation of the axes. Corner bits: 1 = x, 2 = y, 4 = z.
void cut_cell(TetMesh& mesh, const std::array<int, 8>& corner, int start) {
  std::array<int, 3> axes{0, 1, 2};
  do {
    const int a = start ^ (1 << axes[0]);
    const int b = a ^ (1 << axes[1]);
    add_positive(mesh, {corner[start], corner[a], corner[b], corner[start ^ 7]});
  } while (std::next_permutation(axes.begin(), axes.end()));
}

// One tetrahedron of every other corner, `odd` of their bits set or not, and one of each corner between with
// its three neighbours. Cells side by side take turns and so agree on the diagonals of their faces.
void cut_cell_in_five(TetMesh& mesh, const std::array<int, 8>& corner, bool odd) {
  const std::array<int, 4> inner = odd ? std::array{1, 2, 4, 7} : std::array{0, 3, 5, 6};
  add_positive(mesh, {corner[inner[0]], corner[inner[1]], corner[inner[2]], corner[inner[3]]});
  for (int c : odd ? std::array{0, 3, 5, 6} : std::array{1, 2, 4, 7})
    add_positive(mesh, {corner[c], corner[c ^ 1], corner[c ^ 2], corner[c ^ 4]});
}

// Nodes and groups of a block, and its cells, each cut by `cut(mesh, corner, i, j, k)`.
template <class Cut>
TetMesh make_grid(const std::vector<double>& xs, const std::vector<double>& ys, const std::vector<double>& zs,
                  Cut&& cut) {
  for (const auto* axis : {&xs, &ys, &zs}) check_axis(*axis);
  const int nx = static_cast<int>(xs.size()), ny = static_cast<int>(ys.size()), nz = static_cast<int>(zs.size());
  const auto node = [&](int i, int j, int k) { return (k * ny + j) * nx + i; };

  TetMesh mesh;
  mesh.nodes.reserve(static_cast<std::size_t>(nx) * ny * nz);
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        const int n = node(i, j, k);
        mesh.nodes.emplace_back(xs[i], ys[j], zs[k]);
        if (i == 0) mesh.groups["x0"].nodes.push_back(n);
        if (i == nx - 1) mesh.groups["x1"].nodes.push_back(n);
        if (j == 0) mesh.groups["y0"].nodes.push_back(n);
        if (j == ny - 1) mesh.groups["y1"].nodes.push_back(n);
        if (k == 0) mesh.groups["z0"].nodes.push_back(n);
        if (k == nz - 1) mesh.groups["z1"].nodes.push_back(n);
      }
    }
  }
  mesh.groups["bottom"] = mesh.groups["z0"];
  mesh.groups["top"] = mesh.groups["z1"];

  for (int k = 0; k + 1 < nz; ++k) {
    for (int j = 0; j + 1 < ny; ++j) {
      for (int i = 0; i + 1 < nx; ++i) {
        std::array<int, 8> corner;
        for (int c = 0; c < 8; ++c) corner[c] = node(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
        cut(mesh, corner, i, j, k);
      }
    }
  }
  return mesh;
}

// Three tetrahedra of a prism. The corners come in the order of their colours, which both prisms at a shared
// side agree on, and so cut it along the same diagonal.
void cut_prism(TetMesh& mesh, const std::array<int, 3>& below, const std::array<int, 3>& above) {
  add_positive(mesh, {below[0], below[1], below[2], above[2]});
  add_positive(mesh, {below[0], below[1], above[1], above[2]});
  add_positive(mesh, {below[0], above[0], above[1], above[2]});
}

struct Disc {
  std::vector<Eigen::Vector2d> points;        // unit radius
  std::vector<std::array<int, 3>> triangles;  // corners ordered by colour
  int first_rim;                              // points from here on lie on the rim
};

// Point j of ring k; ring k has 6k points and starts after 1 + 3k(k-1).
int disc_index(int ring, int j) {
  return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + j % (6 * ring);
}

// A triangular lattice has three colours, and each of its triangles one corner of each. Point (ring k, sector
// s, step i) stands at k*e_s + i*(e_{s+1} - e_s); a step along e_s changes the colour by +1 for even s, -1
// for odd.
int colour(int ring, int j) {
  if (ring == 0) return 0;
  const int index = j % (6 * ring), sector = index / ring, step = index % ring;
  const int along = sector % 2 == 0 ? 1 : -1;
  return (((ring - 2 * step) * along) % 3 + 3) % 3;
}

void add_triangle(Disc& disc, std::array<std::array<int, 2>, 3> ring_and_step) {
  std::sort(ring_and_step.begin(), ring_and_step.end(),
            [](const auto& a, const auto& b) { return colour(a[0], a[1]) < colour(b[0], b[1]); });
  const auto& c = ring_and_step;
  disc.triangles.push_back({disc_index(c[0][0], c[0][1]), disc_index(c[1][0], c[1][1]), disc_index(c[2][0], c[2][1])});
}

Disc make_disc(int rings) {
  Disc disc;
  disc.points.emplace_back(0, 0);
  for (int k = 1; k <= rings; ++k) {
    for (int j = 0; j < 6 * k; ++j) {
      const double angle = std::numbers::pi * j / (3.0 * k), r = static_cast<double>(k) / rings;
      disc.points.emplace_back(r * std::cos(angle), r * std::sin(angle));
    }
  }
  for (int k = 1; k <= rings; ++k) {
    for (int sector = 0; sector < 6; ++sector) {
      for (int i = 0; i < k; ++i) {
        const int outer = sector * k + i, inner = sector * (k - 1) + i;
        add_triangle(disc, {{{k, outer}, {k, outer + 1}, {k - 1, inner}}});
        if (i + 1 < k) add_triangle(disc, {{{k, outer + 1}, {k - 1, inner + 1}, {k - 1, inner}}});
      }
    }
  }
  disc.first_rim = disc_index(rings, 0);
  return disc;
}

}  // namespace

TetMesh make_block(const Eigen::Vector3d& min, const Eigen::Vector3d& max, const std::array<int, 3>& cells) {
  const auto axes = even_axes(min, max, cells);
  return make_graded_block(axes[0], axes[1], axes[2]);
}

TetMesh make_graded_block(const std::vector<double>& xs, const std::vector<double>& ys, const std::vector<double>& zs) {
  return make_grid(xs, ys, zs, [](TetMesh& mesh, const std::array<int, 8>& corner, int i, int j, int k) {
    cut_cell(mesh, corner, (i & 1) | (j & 1) << 1 | (k & 1) << 2);
  });
}

TetMesh make_block_of_five(const Eigen::Vector3d& min, const Eigen::Vector3d& max, const std::array<int, 3>& cells) {
  const auto axes = even_axes(min, max, cells);
  return make_grid(axes[0], axes[1], axes[2], [](TetMesh& mesh, const std::array<int, 8>& corner, int i, int j, int k) {
    cut_cell_in_five(mesh, corner, (i + j + k) % 2 == 1);
  });
}

std::vector<double> graded_axis(double begin, double end, int cells, double ratio) {
  require(cells >= 1 && ratio > 0 && end > begin, "a grid axis needs a cell, a positive ratio and a positive extent");
  std::vector<double> axis{begin};
  double total = 0, step = 1;
  for (int i = 0; i < cells; ++i, step *= ratio) total += step;
  step = 1;
  double sum = 0;
  for (int i = 0; i + 1 < cells; ++i, step *= ratio) {
    sum += step;
    axis.push_back(begin + (end - begin) * (sum / total));
  }
  axis.push_back(end);
  return axis;
}

std::vector<double> centred_axis(double begin, double end, int cells, double ratio) {
  require(cells >= 2 && cells % 2 == 0, "an axis graded about its middle needs an even number of cells");
  const double middle = 0.5 * (begin + end);
  const std::vector<double> half = graded_axis(0, end - middle, cells / 2, ratio);
  std::vector<double> axis;
  for (std::size_t i = half.size(); i-- > 1;) axis.push_back(middle - half[i]);
  for (double h : half) axis.push_back(middle + h);
  axis.front() = begin;
  axis.back() = end;
  return axis;
}

TetMesh make_cylinder(double radius, double height, int rings, int layers) {
  require(radius > 0 && height > 0, "a cylinder needs a positive radius and height");
  require(rings >= 1 && layers >= 1, "a cylinder needs at least one ring and one layer");
  const Disc disc = make_disc(rings);
  const int per_layer = static_cast<int>(disc.points.size());

  TetMesh mesh;
  for (int k = 0; k <= layers; ++k) {
    for (int p = 0; p < per_layer; ++p) {
      const int n = static_cast<int>(mesh.nodes.size());
      mesh.nodes.emplace_back(radius * disc.points[p].x(), radius * disc.points[p].y(), height * k / layers);
      if (k == 0) mesh.groups["bottom"].nodes.push_back(n);
      if (k == layers) mesh.groups["top"].nodes.push_back(n);
      if (p >= disc.first_rim) mesh.groups["side"].nodes.push_back(n);
    }
  }
  for (int k = 0; k < layers; ++k) {
    for (const auto& triangle : disc.triangles) {
      std::array<int, 3> below, above;
      for (int c = 0; c < 3; ++c) {
        below[c] = k * per_layer + triangle[c];
        above[c] = below[c] + per_layer;
      }
      k % 2 == 0 ? cut_prism(mesh, below, above) : cut_prism(mesh, above, below);
    }
  }
  return mesh;
}

}  // namespace palpate

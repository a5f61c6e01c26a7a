#include "common/fem/refine_graded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <stdexcept>

#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

using Edge = std::array<int, 2>;

constexpr double kStride = 1.15;
constexpr int kMaxStrides = 12;
constexpr double kUnderBall = 0.8;  // of its radius: the disc on which the mesh is finest

Edge edge_of(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

/// A mesh whose edges are split one after another.
class Splitter {
 public:
  Splitter(const StaticProblem& problem, const SizeField& size)
      : nodes_(problem.mesh.nodes),
        size_(size),
        tets_(problem.mesh.tetrahedra),
        material_(problem.materials.of_element) {
    around_.resize(nodes_.size());
    for (int t = 0; t < static_cast<int>(tets_.size()); ++t) link(t);
    for (std::size_t n = 0; n < nodes_.size(); ++n) fixed_.push_back(fixed_axes(problem.dofs, static_cast<int>(n)));
    for (const auto& face : extract_surface(problem.mesh).triangles) add_face(face);
    for (int t = 0; t < static_cast<int>(tets_.size()); ++t) note_edges(t);
  }

  void run(int max_nodes) {
    while (!longest_.empty()) {
      const auto [ratio, edge] = longest_.top();
      longest_.pop();
      if (static_cast<int>(nodes_.size()) >= max_nodes)
        throw std::runtime_error(fmt::format("the graded mesh would have more than {} nodes", max_nodes));
      split(edge);
    }
  }

  StaticProblem finished(const StaticProblem& from) const {
    TetMesh mesh{nodes_, {}, {}};
    MaterialField materials{from.materials.materials, {}, {}};
    for (std::size_t t = 0; t < tets_.size(); ++t) {
      if (tets_[t][0] < 0) continue;
      mesh.tetrahedra.push_back(tets_[t]);
      if (!material_.empty()) materials.of_element.push_back(material_[t]);
    }
    DofMap dofs(mesh);
    for (int n = 0; n < static_cast<int>(nodes_.size()); ++n)
      for (int axis = 0; axis < 3; ++axis)
        if (fixed_[n] >> axis & 1 && dofs.index(n, axis) != DofMap::kUnused) dofs.fix(n, axis);
    dofs.number();
    return {std::move(mesh), std::move(materials), std::move(dofs)};
  }

 private:
  struct Long {
    double ratio;
    Edge edge;
    bool operator<(const Long& other) const { return std::tie(ratio, edge) < std::tie(other.ratio, other.edge); }
  };

  static int fixed_axes(const DofMap& dofs, int node) {
    int axes = 0;
    for (int axis = 0; axis < 3; ++axis)
      if (dofs.index(node, axis) == DofMap::kFixed) axes |= 1 << axis;
    return axes;
  }

  void link(int t) {
    for (const int n : tets_[t]) around_[n].push_back(t);
  }

  void note(int a, int b) {
    const double ratio = (nodes_[a] - nodes_[b]).norm() / size_(0.5 * (nodes_[a] + nodes_[b]));
    if (ratio > 1) longest_.push({ratio, edge_of(a, b)});
  }

  void note_edges(int t) {
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j)
        if (seen_.insert({edge_of(tets_[t][i], tets_[t][j]), 0}).second) note(tets_[t][i], tets_[t][j]);
  }

  void add_face(const std::array<int, 3>& face) {
    for (int v = 0; v < 3; ++v) faces_.emplace(edge_of(face[v], face[(v + 1) % 3]), face[(v + 2) % 3]);
  }

  void drop_face(const std::array<int, 3>& face) {
    for (int v = 0; v < 3; ++v) {
      const auto [begin, end] = faces_.equal_range(edge_of(face[v], face[(v + 1) % 3]));
      for (auto f = begin; f != end; ++f)
        if (f->second == face[(v + 2) % 3]) {
          faces_.erase(f);
          break;
        }
    }
  }

  /// Faces of the surface beside the edge: both are split, and the new node inherits what they hold.
  int split_faces(const Edge& e, int middle) {
    std::vector<int> across;
    const auto [begin, end] = faces_.equal_range(e);
    for (auto f = begin; f != end; ++f) across.push_back(f->second);
    int fixed = 0;
    for (const int c : across) {
      fixed |= fixed_[e[0]] & fixed_[e[1]] & fixed_[c];
      drop_face({e[0], e[1], c});
      add_face({e[0], middle, c});
      add_face({middle, e[1], c});
    }
    return fixed;
  }

  void split(const Edge& e) {
    std::vector<int> both;
    for (const int t : around_[e[0]])
      if (tets_[t][0] >= 0 && std::ranges::count(tets_[t], e[0]) && std::ranges::count(tets_[t], e[1]))
        both.push_back(t);
    const int middle = static_cast<int>(nodes_.size());
    nodes_.push_back(0.5 * (nodes_[e[0]] + nodes_[e[1]]));
    around_.emplace_back();
    fixed_.push_back(0);
    fixed_[middle] = split_faces(e, middle);
    for (const int t : both) {
      std::array<int, 4> first = tets_[t], second = tets_[t];
      std::ranges::replace(first, e[1], middle);
      std::ranges::replace(second, e[0], middle);
      tets_[t] = first;
      std::erase(around_[e[1]], t);
      around_[middle].push_back(t);
      tets_.push_back(second);
      if (!material_.empty()) material_.push_back(material_[t]);
      link(static_cast<int>(tets_.size()) - 1);
      note_edges(t);
      note_edges(static_cast<int>(tets_.size()) - 1);
    }
  }

  std::vector<Eigen::Vector3d> nodes_;
  const SizeField& size_;
  std::vector<std::array<int, 4>> tets_;
  std::vector<std::uint16_t> material_;
  std::vector<std::vector<int>> around_;
  std::vector<int> fixed_;          // bits of axes per node
  std::multimap<Edge, int> faces_;  // of the surface: edge to the corner across
  std::map<Edge, char> seen_;
  std::priority_queue<Long> longest_;
};

}  // namespace

StaticProblem refine_graded(const StaticProblem& problem, const SizeField& size, int max_nodes) {
  Splitter splitter(problem, size);
  splitter.run(max_nodes);
  return splitter.finished(problem);
}

double mean_edge(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.tetrahedra)
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) sum += (mesh.nodes[t[i]] - mesh.nodes[t[j]]).norm();
  return sum / (6.0 * static_cast<double>(mesh.tetrahedra.size()));
}

double size_around(const Eigen::Vector3d& place, const Eigen::Vector3d& centre, const Eigen::Vector3d& axis,
                   double radius, double inner, double growth) {
  const double high = (place - centre).dot(axis), out = (place - centre - high * axis).norm() - radius;
  return inner + growth * std::hypot(high, std::max(0.0, out));
}

StaticProblem refine_under_ball(const StaticProblem& problem, std::span<const PressedSpot> spots,
                                const Fineness& fineness, int& strides) {
  for (;; ++strides) {
    const double faster = std::pow(kStride, strides);
    const double outer = faster * fineness.edge * mean_edge(problem.mesh);
    const SizeField size = [&](const Eigen::Vector3d& x) {
      double least = outer;
      for (const PressedSpot& spot : spots) {
        const double inner = std::min(outer, fineness.ball * spot.radius);
        least = std::min(
            least, size_around(x, spot.point, spot.inward, kUnderBall * spot.radius, inner, faster * fineness.growth));
      }
      return least;
    };
    try {
      return refine_graded(problem, size, fineness.max_nodes);
    } catch (const std::runtime_error&) {
      if (strides == kMaxStrides) throw;
    }
  }
}

}  // namespace palpate

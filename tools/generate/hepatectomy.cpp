#include "tools/generate/hepatectomy.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <stdexcept>

#include "common/mesh/quality.hpp"
#include "tools/generate/liver.hpp"

namespace palpate {
namespace {

constexpr int kSegment = 1260;  // tetrahedra
constexpr int kSearch = 200;    // how many more or fewer may be taken

bool is_sound(const TetMesh& mesh, std::span<const int> part) {
  TetMesh alone;
  alone.nodes = mesh.nodes;
  for (int t : part) alone.tetrahedra.push_back(mesh.tetrahedra[t]);
  try {
    check_tet_mesh(alone, "part");
  } catch (const std::runtime_error&) {
    return false;
  }
  return true;
}

/// Tetrahedra from the right lobe to the end of the left one, by their centroids.
std::vector<int> along_the_organ(const TetMesh& mesh) {
  const Eigen::Vector3d direction(1, 0, 0.1);
  const auto place = [&](int t) {
    double sum = 0;
    for (int n : mesh.tetrahedra[t]) sum += mesh.nodes[n].dot(direction);
    return sum;
  };
  std::vector<int> order(mesh.tetrahedra.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return place(a) < place(b); });
  return order;
}

/// How many tetrahedra at the start of the order are left when the rest is the segment.
std::size_t cut_place(const TetMesh& mesh, std::span<const int> order) {
  for (int away = 0; away <= kSearch; ++away) {
    for (int count : {kSegment - away, kSegment + away}) {
      const std::size_t rest = order.size() - count;
      if (is_sound(mesh, order.subspan(rest)) && is_sound(mesh, order.first(rest))) return rest;
    }
  }
  throw std::runtime_error("the organ cannot be parted where the segment begins");
}

void add_group(TetMesh& mesh, const char* name, std::size_t begin, std::size_t end) {
  MeshGroup& group = mesh.groups[name];
  for (std::size_t t = begin; t < end; ++t) {
    group.tetrahedra.push_back(static_cast<int>(t));
    group.nodes.insert(group.nodes.end(), mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end());
  }
  std::sort(group.nodes.begin(), group.nodes.end());
  group.nodes.erase(std::unique(group.nodes.begin(), group.nodes.end()), group.nodes.end());
}

}  // namespace

TetMesh make_hepatectomy() {
  TetMesh mesh = make_liver({.frequency = 8, .inner_size = 0.01008});
  mesh.groups.erase("liver");
  std::vector<int> order = along_the_organ(mesh);
  const std::size_t rest = cut_place(mesh, order);
  std::sort(order.begin(), order.begin() + rest);
  std::sort(order.begin() + rest, order.end());
  std::vector<std::array<int, 4>> tetrahedra;
  for (int t : order) tetrahedra.push_back(mesh.tetrahedra[t]);
  mesh.tetrahedra = std::move(tetrahedra);
  add_group(mesh, "remnant", 0, rest);
  add_group(mesh, "segment", rest, mesh.tetrahedra.size());
  return mesh;
}

}  // namespace palpate

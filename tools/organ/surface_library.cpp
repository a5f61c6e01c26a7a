#include "tools/organ/surface_library.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "tools/organ/plain_words.hpp"

namespace palpate {
namespace {

namespace processing = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangles = std::vector<Kernel::Triangle_3>;

Point point_of(const Eigen::Vector3d& x) {
  return {x.x(), x.y(), x.z()};
}
Eigen::Vector3d vector_of(const Point& p) {
  return {p.x(), p.y(), p.z()};
}

std::vector<Point> points_of(const std::vector<Eigen::Vector3d>& places) {
  std::vector<Point> points;
  for (const Eigen::Vector3d& x : places) points.push_back(point_of(x));
  return points;
}

/// +1, -1: the ray from x along `direction` goes through the triangle with or against its normal; 0: it misses; 2: it
/// meets an edge, or nearly.
int crossing(const Kernel::Triangle_3& t, const Eigen::Vector3d& x, const Eigen::Vector3d& direction) {
  constexpr double kNearEdge = 1e-12;
  const Eigen::Vector3d a = vector_of(t[0]) - x, b = vector_of(t[1]) - x, c = vector_of(t[2]) - x;
  const double u = direction.dot(b.cross(c)), v = direction.dot(c.cross(a)), w = direction.dot(a.cross(b));
  const double size = std::abs(u) + std::abs(v) + std::abs(w);
  if (std::min({std::abs(u), std::abs(v), std::abs(w)}) <= kNearEdge * size) return 2;
  if ((u > 0) != (v > 0) || (u > 0) != (w > 0)) return 0;
  const double along = (u * a + v * b + w * c).dot(direction) / (u + v + w);
  return along <= 0 ? 0 : u > 0 ? 1 : -1;
}

/// Whether two triangles do no more than touch in a corner or an edge that they have at the same places.
bool touch_alone(const TriangleMesh& mesh, int first, int second) {
  std::array<int, 3> a = mesh.triangles[first], b = mesh.triangles[second];
  std::size_t same = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = same; j < 3; ++j) {
      if (mesh.nodes[a[i]] != mesh.nodes[b[j]]) continue;
      std::swap(a[same], a[i]);
      std::swap(b[same++], b[j]);
      break;
    }
  if (same != 1) return same == 2;
  const auto corner = [&](int n) { return point_of(mesh.nodes[n]); };
  const auto meets = [&](const std::array<int, 3>& edge, const std::array<int, 3>& t) {
    return CGAL::do_intersect(Kernel::Segment_3(corner(edge[1]), corner(edge[2])),
                              Kernel::Triangle_3(corner(t[0]), corner(t[1]), corner(t[2])));
  };
  return !meets(a, b) && !meets(b, a);
}

}  // namespace

void orient_triangles(TriangleMesh& mesh) {
  std::vector<Point> points = points_of(mesh.nodes);
  std::vector<std::vector<std::size_t>> polygons;
  for (const auto& t : mesh.triangles) polygons.emplace_back(t.begin(), t.end());
  in_plain_words("its triangles cannot be turned to agree",
                 [&] { return processing::orient_polygon_soup(points, polygons); });
  for (std::size_t n = mesh.nodes.size(); n < points.size(); ++n) mesh.nodes.push_back(vector_of(points[n]));
  for (std::size_t i = 0; i < polygons.size(); ++i)
    for (int c = 0; c < 3; ++c) mesh.triangles[i][c] = static_cast<int>(polygons[i][c]);
}

std::vector<std::array<int, 3>> close_loop(const std::vector<Eigen::Vector3d>& loop) {
  std::vector<CGAL::Triple<int, int, int>> patch;
  in_plain_words("a hole cannot be closed",
                 [&] { return processing::triangulate_hole_polyline(points_of(loop), std::back_inserter(patch)); });
  std::vector<std::array<int, 3>> triangles;
  for (const auto& t : patch) triangles.push_back({t.first, t.second, t.third});
  return triangles;
}

std::vector<std::pair<int, int>> crossing_triangles(const TriangleMesh& mesh) {
  CGAL::Surface_mesh<Point> surface;
  std::vector<std::vector<std::size_t>> polygons;
  for (const auto& t : mesh.triangles) polygons.emplace_back(t.begin(), t.end());
  std::vector<std::pair<CGAL::SM_Face_index, CGAL::SM_Face_index>> faces;
  in_plain_words("its triangles do not make a surface", [&] {
    processing::polygon_soup_to_polygon_mesh(points_of(mesh.nodes), polygons, surface);
    return processing::self_intersections(surface, std::back_inserter(faces));
  });
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [a, b] : faces)
    if (!touch_alone(mesh, static_cast<int>(a), static_cast<int>(b)))
      pairs.emplace_back(std::minmax(static_cast<int>(a), static_cast<int>(b)));
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;

struct SurfaceTree::Tree {
  Triangles triangles;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> boxes;
};

SurfaceTree::SurfaceTree(const TriangleMesh& mesh) : tree_(std::make_unique<Tree>()) {
  for (const auto& [a, b, c] : mesh.triangles) {
    const Kernel::Triangle_3 t(point_of(mesh.nodes[a]), point_of(mesh.nodes[b]), point_of(mesh.nodes[c]));
    if (!t.is_degenerate()) tree_->triangles.push_back(t);
  }
  tree_->boxes.insert(tree_->triangles.cbegin(), tree_->triangles.cend());
  tree_->boxes.accelerate_distance_queries();
}

SurfaceTree::~SurfaceTree() = default;
SurfaceTree::SurfaceTree(SurfaceTree&&) noexcept = default;

double SurfaceTree::distance(const Eigen::Vector3d& x) const {
  return std::sqrt(tree_->boxes.squared_distance(point_of(x)));
}

double SurfaceTree::distance(const Eigen::Vector3d& x, double most) const {
  return (nearest(x, x + most * Eigen::Vector3d::UnitX()) - x).norm();
}

Eigen::Vector3d SurfaceTree::nearest(const Eigen::Vector3d& x) const {
  return vector_of(tree_->boxes.closest_point(point_of(x)));
}

Eigen::Vector3d SurfaceTree::nearest(const Eigen::Vector3d& x, const Eigen::Vector3d& guess) const {
  return vector_of(tree_->boxes.closest_point(point_of(x), point_of(guess)));
}

std::vector<std::pair<double, int>> SurfaceTree::crossings_along_x(const Eigen::Vector3d& x) const {
  std::vector<Triangles::const_iterator> met;
  tree_->boxes.all_intersected_primitives(Kernel::Ray_3(point_of(x), Kernel::Vector_3(1, 0, 0)),
                                          std::back_inserter(met));
  std::vector<std::pair<double, int>> places;
  for (const auto t : met) {
    const Eigen::Vector3d a = vector_of((*t)[0]), normal = (vector_of((*t)[1]) - a).cross(vector_of((*t)[2]) - a);
    if (normal.x() != 0) places.emplace_back(normal.dot(a - x) / normal.x(), normal.x() < 0 ? 1 : -1);
  }
  std::sort(places.begin(), places.end());
  return places;
}

int SurfaceTree::winding(const Eigen::Vector3d& x) const {
  constexpr int kDirections = 20;  // more than one only where a ray meets an edge
  std::vector<Triangles::const_iterator> met;
  for (int i = 0; i < kDirections; ++i) {
    const Eigen::Vector3d direction = Eigen::Vector3d(0.8660 + 0.1 * i, 0.3217 - 0.07 * i, 0.3829 + 0.13 * i);
    met.clear();
    tree_->boxes.all_intersected_primitives(
        Kernel::Ray_3(point_of(x), Kernel::Vector_3(direction.x(), direction.y(), direction.z())),
        std::back_inserter(met));
    int sum = 0;
    bool clear = true;
    for (const auto t : met) {
      const int way = crossing(*t, x, direction);
      clear = clear && way != 2;
      sum += way;
    }
    if (clear) return sum;
  }
  return 0;
}

}  // namespace palpate

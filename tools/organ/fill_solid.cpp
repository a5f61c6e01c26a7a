#include "tools/organ/fill_solid.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/make_mesh_3.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "tools/organ/plain_words.hpp"
#include "tools/organ/surface_samples.hpp"

namespace palpate {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Labels = CGAL::Labeled_mesh_domain_3<Kernel>;

constexpr double kFacetAngle = 30;   // [degrees] least angle of a triangle
constexpr double kRadiusEdge = 2;    // largest circumradius over shortest edge
constexpr double kMinAngle = 15;     // [degrees] dihedral angle that worse tetrahedra are brought to
constexpr double kBisection = 1e-4;  // of the box's diagonal: where the surface is found

Eigen::Vector3d vector_of(const Point& p) {
  return {p.x(), p.y(), p.z()};
}
Point point_of(const Eigen::Vector3d& x) {
  return {x.x(), x.y(), x.z()};
}

/// Begins on every part's surface; CGAL's own domain looks from the middle and overlooks small parts.
class Domain : public Labels {
 public:
  Domain(const Solid& solid, const Kernel::Iso_cuboid_3& box, std::vector<SurfaceSample> samples)
      : Labels(
            CGAL::parameters::function = [&solid](const Point& p) { return solid.part(vector_of(p)); },
            CGAL::parameters::bounding_object = box, CGAL::parameters::relative_error_bound = kBisection),
        samples_(std::move(samples)) {}

  struct Construct_initial_points {
    const Domain& domain;
    template <class Output>
    Output operator()(Output points, int = 0) const {
      for (const SurfaceSample& s : domain.samples_)
        *points++ = std::pair(point_of(s.place), domain.index_from_surface_patch_index({s.parts[0], s.parts[1]}));
      return points;
    }
  };
  Construct_initial_points construct_initial_points_object() const { return {*this}; }

 private:
  std::vector<SurfaceSample> samples_;
};

using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

/// `factor`: from an edge to the radius that CGAL bounds.
struct SizeField {
  using FT = Kernel::FT;
  const Solid& solid;
  const MeshSizes& sizes;
  double factor;
  FT operator()(const Point& p, int, const Domain::Index&) const {
    const Eigen::Vector3d x = vector_of(p);
    return factor * asked_edge(sizes, x, solid.depth(x));
  }
};

bool comes_before(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

/// Nodes ordered by place and tetrahedra by nodes, whatever order the library keeps them in.
FilledSolid in_order(const Complex& complex) {
  std::vector<Triangulation::Vertex_handle> vertices;
  std::map<Triangulation::Vertex_handle, int> number;
  for (auto c = complex.cells_in_complex_begin(); c != complex.cells_in_complex_end(); ++c)
    for (int v = 0; v < 4; ++v)
      if (number.emplace(c->vertex(v), 0).second) vertices.push_back(c->vertex(v));
  const auto place = [](Triangulation::Vertex_handle v) {
    return Eigen::Vector3d(v->point().x(), v->point().y(), v->point().z());
  };
  std::ranges::sort(vertices, [&](auto a, auto b) { return comes_before(place(a), place(b)); });
  FilledSolid filled;
  for (std::size_t n = 0; n < vertices.size(); ++n) {
    number[vertices[n]] = static_cast<int>(n);
    filled.mesh.nodes.push_back(place(vertices[n]));
  }
  std::vector<std::pair<std::array<int, 4>, int>> tetrahedra;
  for (auto c = complex.cells_in_complex_begin(); c != complex.cells_in_complex_end(); ++c) {
    std::array<int, 4> t;
    for (int v = 0; v < 4; ++v) t[v] = number.at(c->vertex(v));
    // An even permutation that puts the least node first and keeps the orientation.
    const auto first = std::ranges::min_element(t) - t.begin();
    if (first != 0) {
      std::swap(t[0], t[first]);
      const int other = first == 1 ? 2 : 1, last = first == 3 ? 2 : 3;
      std::swap(t[other], t[last]);
    }
    while (t[1] > t[2] || t[1] > t[3]) t = {t[0], t[2], t[3], t[1]};
    tetrahedra.emplace_back(t, static_cast<int>(complex.subdomain_index(c)));
  }
  std::ranges::sort(tetrahedra);
  for (const auto& [t, part] : tetrahedra) {
    filled.mesh.tetrahedra.push_back(t);
    filled.part.push_back(part);
  }
  return filled;
}

/// Times the thickness of a wall: how far apart its points are that are begun with. Two find both sides of a plate; in
/// a rod no tetrahedron between such points may have its middle, and then none is found.
constexpr double kApart[] = {2, 1, 0.5};

FilledSolid fill(const Solid& solid, const MeshSizes& sizes, bool better) {
  namespace given = CGAL::parameters;
  double step = sizes.edge;
  for (const FinePlace& f : sizes.fine) step = std::min(step, f.edge);
  const Kernel::Iso_cuboid_3 box(point_of(solid.low), point_of(solid.high));
  const Criteria criteria(given::facet_angle = kFacetAngle, given::facet_size = SizeField{solid, sizes, 0.6},
                          given::facet_distance = sizes.deviation,
                          given::facet_topology = solid.parts == 1 ? CGAL::MANIFOLD : CGAL::FACET_VERTICES_ON_SURFACE,
                          given::cell_radius_edge_ratio = kRadiusEdge, given::cell_size = SizeField{solid, sizes, 0.7});
  for (const double apart : kApart) {
    const Domain domain(solid, box, surface_samples(solid, step, apart));
    Complex complex = CGAL::make_mesh_3<Complex>(domain, criteria, given::no_lloyd(), given::no_odt(),
                                                 given::no_perturb(), given::no_exude());
    if (complex.number_of_cells_in_complex() == 0) continue;
    if (better) {
      CGAL::perturb_mesh_3(complex, domain, given::time_limit = 0, given::sliver_bound = kMinAngle);
      CGAL::exude_mesh_3(complex, given::time_limit = 0, given::sliver_bound = kMinAngle);
    }
    return in_order(complex);
  }
  throw std::runtime_error("no tetrahedra came of it");
}

}  // namespace

FilledSolid fill_solid(const Solid& solid, const MeshSizes& sizes, bool better) {
  return in_plain_words("it cannot be filled with tetrahedra of that size", [&] { return fill(solid, sizes, better); });
}

}  // namespace palpate

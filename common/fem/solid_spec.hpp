#pragma once
#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/mesh/selector.hpp"
#include "common/mesh/visual_spec.hpp"

namespace palpate {

struct Archive;

struct Material {
  double young = 0;       ///< [Pa]
  double poisson = 0;     ///< [1], > -1, < 0.5
  double density = 1000;  ///< [kg/m^3]
};

/// Far above what there is, so that nothing that is made of them overflows.
inline constexpr Range kYoungRange = above_up_to(0, 1e20);           ///< [Pa]; diamond has 1e12
inline constexpr Range kDensityRange = above_up_to(0, 1e6);          ///< [kg/m^3]; osmium has 2.3e4
inline constexpr Range kPressureRange = strictly_within(-1e9, 1e9);  ///< [Pa]
/// Positive definite elasticity that is not incompressible.
inline constexpr Range kPoissonRange = strictly_within(-1, 0.5);

inline void describe(Description& d, Material& m) {
  d.number({"young", "Pa", "Young's modulus", Need::required, Use::stored}, m.young, kYoungRange);
  d.number({"poisson", "1", "Poisson's ratio", Need::required, Use::stored}, m.poisson, kPoissonRange);
  d.number({"density", "kg/m³", "mass per volume", Need::optional, Use::inertia}, m.density, kDensityRange);
}

/// A part of another material.
struct MaterialRegion {
  Selector where;
  Material material;
};

inline void describe(Description& d, MaterialRegion& r) {
  describe(d, r.where, "elements");
  d.require(d.given("young") || d.given("poisson") || d.given("density"), "",
            "[[body.material]] needs at least one of 'young', 'poisson' and 'density'");
  d.number({"young", "Pa", "Young's modulus", Need::optional, Use::stored, "the body's"}, r.material.young,
           kYoungRange);
  d.number({"poisson", "1", "Poisson's ratio", Need::optional, Use::stored, "the body's"}, r.material.poisson,
           kPoissonRange);
  d.number({"density", "kg/m³", "mass per volume", Need::optional, Use::inertia, "the body's"}, r.material.density,
           kDensityRange);
}

/// Nodes whose displacement is zero along some axes.
struct BoundaryCondition {
  Selector where;
  std::array<bool, 3> axes{true, true, true};  ///< which of x, y, z are held
};

inline void describe(Description& d, BoundaryCondition& b) {
  describe(d, b.where, "nodes");
  d.axes({"axes", "", "which displacements are zero: letters of `x`, `y`, `z`", Need::optional, Use::stored}, b.axes);
}

/// A dead load on some nodes; one of its two kinds is set in a validated scene.
struct LoadSpec {
  Selector where;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< [N] on all of them together
  double pressure = 0;                              ///< [Pa] on the triangles among them, against their normals
};

inline void describe(Description& d, LoadSpec& l) {
  describe(d, l.where, "nodes");
  if (!d.writes() || l.pressure == 0)
    d.vector(
        {"force", "N", "on these nodes together, each takes the same share of it", Need::optional, Use::stored, "none"},
        l.force);
  if (!d.writes() || l.pressure != 0)
    d.number({"pressure", "Pa",
              "on the triangles of the surface whose corners are among these nodes, against their outward normals; "
              "below zero it pulls",
              Need::optional, Use::stored, "none"},
             l.pressure, kPressureRange);
  d.require(d.given("force") != d.given("pressure"), "", "a [[body.load]] is either a 'force' or a 'pressure'");
}

/// What every body has.
struct NamedSpec {
  std::string name;
};

inline void describe(Description& d, NamedSpec& b) {
  d.name({"name", "", "1 to 31 letters, digits, `_` or `-`; different for each body", Need::required}, b.name);
}

/// A body with a mesh.
struct MeshedSpec : NamedSpec {
  std::filesystem::path mesh;
  double scale = 1;  ///< [m per mesh unit]
  Material material;
  std::optional<NodeSelector> touchable;  ///< absent: every free surface node
  std::vector<LoadSpec> loads;
};

inline void describe(Description& d, MeshedSpec& b) {
  describe(d, static_cast<NamedSpec&>(b));
  d.file({"mesh", "", "tetrahedra: Gmsh 1.0, 2.2 or 4.1, or legacy VTK; of a shell triangles, in these formats or STL",
          Need::required, Use::stored},
         b.mesh);
  d.number({"scale", "m", "length of the mesh's unit", Need::optional, Use::stored}, b.scale, above(0));
  describe(d, b.material);
  d.table({"touchable", "", "which nodes a tool can touch", Need::optional, Use::stored, "every free surface node"},
          b.touchable);
  d.tables({"load", "", "what pulls or presses it all the time", Need::optional, Use::stored, "none"}, b.loads);
}

/// The weight of a body that is solved beforehand.
inline void describe_weight(Description& d, Eigen::Vector3d& gravity) {
  if (d.writes() && gravity.isZero(0)) return;
  d.vector({"gravity", "m/s²", "of its own weight; zero where its mesh is its shape under it already", Need::optional,
            Use::stored},
           gravity);
}

/// A body of tetrahedra.
struct SolidSpec : MeshedSpec {
  std::vector<BoundaryCondition> fixed;
  std::vector<MaterialRegion> materials;  ///< empty: one material, nothing is stored per element
  std::optional<VisualSpec> visual;       ///< absent: its own surface is drawn
};

/// Refuses a body that nothing holds.
inline void require_fixed(Description& d, const std::string& name, bool fixed) {
  d.require(fixed, "", fmt::format("body '{}' is not fixed anywhere and would float: give it a [[body.fixed]]", name));
}

inline void describe(Description& d, SolidSpec& b) {
  describe(d, static_cast<MeshedSpec&>(b));
  d.tables({"fixed", "", "where the body is held", Need::required, Use::stored}, b.fixed);
  require_fixed(d, b.name, !b.fixed.empty());
  d.tables({"material", "", "parts of another material; where two overlap, the later one counts", Need::optional,
            Use::stored},
           b.materials, {{}, b.material});
  d.table({"visual", "", "what is drawn in its place", Need::optional, Use::local, "its own surface"}, b.visual);
}

}  // namespace palpate

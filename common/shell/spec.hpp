#pragma once
#include <array>
#include <string_view>
#include <vector>

#include "common/fem/solid_spec.hpp"

namespace palpate {

/// Plate bending of a shell triangle.
enum class Bending {
  discrete_kirchhoff,  ///< DKT
  polynomial,          ///< Tocher's nine terms (BHS01 app. A); singular where x3 + 2 y3 = y2
};

inline const auto& words_of(Bending) {
  static constexpr std::array<std::string_view, 2> words{"discrete_kirchhoff", "polynomial"};
  return words;
}

/// A thin wall of shell triangles that moves by its lowest modes (BHS01 sec. V-C-1). The mesh is the wall's middle
/// surface.
struct Shell {
  double thickness = 0;  ///< [m]
  Bending bending = Bending::discrete_kirchhoff;
  int modes = 50;              ///< kept, the lowest ones
  double damping_ratio = 0.2;  ///< [1] of every mode; means nothing with a damping
  double damping = 0;          ///< [1/s] B = damping M (BHS01 eq. 21); 0: the ratio holds
  bool residual = true;        ///< static share of the modes left out, at touched nodes
};

inline void describe(Description& d, Shell& s) {
  d.number({"thickness", "m", "not more than the radius of the tube", Need::required, Use::stored}, s.thickness,
           above(0));
  d.choice({"bending", "",
            "the bending element; `\"polynomial\"` is the paper's, which is singular for some triangles and refused "
            "there",
            Need::optional, Use::stored},
           s.bending);
  d.integer({"modes", "", "how many modes are kept, the lowest ones; at most the free displacements of the mesh",
             Need::optional, Use::stored},
            s.modes, 1, 100000);
  const bool ratio = s.damping == 0;
  if (!d.writes() || ratio)
    d.number({"damping_ratio", "1", "of every mode; 1 is critical"}, s.damping_ratio, at_least(0));
  if (!d.writes() || !ratio)
    d.number({"damping", "1/s", "in its place: proportional to mass, so that slow modes are damped most",
              Need::optional, Use::agreed, "none"},
             s.damping, above(0));
  d.require(!(d.given("damping") && d.given("damping_ratio")), "damping",
            "damping and damping_ratio are two laws of damping: give one of them");
  d.flag({"residual", "", "touched points also give way by what the modes left out would add at rest"}, s.residual);
}

/// Nodes of a shell whose displacement is zero along some axes.
struct ShellBoundaryCondition : BoundaryCondition {
  bool rotations = true;  ///< are held too: clamped, not hinged
};

inline void describe(Description& d, ShellBoundaryCondition& b) {
  describe(d, static_cast<BoundaryCondition&>(b));
  d.flag({"rotations", "", "of a shell: its nodes do not turn there, it is clamped; `false` is a hinge", Need::optional,
          Use::stored},
         b.rotations);
}

/// A body of shell triangles.
struct ShellSpec : MeshedSpec {
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s^2]
  std::vector<ShellBoundaryCondition> fixed;
  Shell shell;
};

inline void describe(Description& d, ShellSpec& b) {
  describe(d, static_cast<MeshedSpec&>(b));
  describe_weight(d, b.gravity);
  d.tables({"fixed", "", "where the body is held", Need::required, Use::stored}, b.fixed);
  require_fixed(d, b.name, !b.fixed.empty());
  d.table({"shell", "", "the wall", Need::required, Use::stored}, b.shell);
}

}  // namespace palpate

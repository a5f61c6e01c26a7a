#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string_view>

#include "common/dynamics/integrator.hpp"
#include "common/fem/solid_spec.hpp"
#include "common/fem/tet_element.hpp"

namespace palpate {

/// Of forces, displacements and velocities.
enum class Precision { float32, float64 };

inline const auto& words_of(Precision) {
  static constexpr std::array<std::string_view, 2> words{"single", "double"};
  return words;
}

/// Motion of tissue that is cut or torn (RR3510 sec. 4).
struct Dynamic {
  Integrator integrator = Integrator::rk4;
  Precision precision = Precision::float32;
  double step = 0;                                    ///< [s] 0: chosen from the frequency bound
  double damping = 5;                                 ///< [1/s] proportional to mass: gamma_i = damping * m_i
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s^2]
  TetElement element = TetElement::linear;
  bool corotational = false;  ///< elements turn with the tissue
  std::optional<Box> resect;  ///< [m] what is to be cut off
};

inline void describe(Description& d, Dynamic& m) {
  d.choice({"integrator", "",
            "`\"rk4\"`: Runge and Kutta's of the fourth order; `\"semi_implicit\"`: Euler's, where the new velocity "
            "moves the position"},
           m.integrator);
  d.choice({"precision", "", "of forces, displacements and velocities"}, m.precision);
  d.number({"step", "s", "0: the largest that is stable, with a margin. One that is given is refused above the bound"},
           m.step, at_least(0));
  d.number({"damping", "1/s", "proportional to mass: a node of mass m is braked by damping · m · velocity"}, m.damping,
           at_least(0));
  d.vector({"gravity", "m/s²", "on both parts of a hybrid", Need::optional, Use::inertia}, m.gravity);
  d.choice({"element", "",
            "`\"linear\"`: tetrahedra of constant strain, too stiff in bending and near ν = 0.5; `\"nodal_strain\"`: "
            "their strain is averaged at the nodes, for soft tissue that bends and hardly changes its volume; not for "
            "springs, and not with `corotational`",
            Need::optional, Use::stored},
           m.element);
  d.flag({"corotational", "",
          "elements turn with the tissue, so that large rotations make no false force; not for "
          "springs, which turn by themselves"},
         m.corotational);
  d.box({"resect", "m",
         "what is to be cut off, least and greatest corner: summaries tell what was cut of the tetrahedra with their "
         "centroid inside, and of the others",
         Need::optional, Use::local},
        m.resect);
  d.require(!m.corotational || m.element == TetElement::linear, "corotational",
            "elements that turn with the tissue are linear: take either corotational or element = \"nodal_strain\"");
}

/// The three measures of RR3510 sec. 5.5 of how far a tetrahedron is deformed. A motion without deformation
/// gives zero, and none depends on the size of the tetrahedron.
enum class TearCriterion { volume, mean_elongation, max_elongation };

inline const auto& words_of(TearCriterion) {
  static constexpr std::array<std::string_view, 3> words{"volume", "mean_elongation", "max_elongation"};
  return words;
}

/// When dynamic tissue tears by itself (RR3510 sec. 4.4).
struct Tearing {
  TearCriterion criterion = TearCriterion::volume;
  double threshold = 0;  ///< [1] > 0, relative change
};

inline void describe(Description& d, Tearing& t) {
  d.choice({"criterion", "",
            "relative change of a tetrahedron's volume, or of its six edges' length, their mean or the largest"},
           t.criterion);
  d.number(
      {"threshold", "1", "a tetrahedron above it is removed, the worst first; 0.5 is a change by half", Need::required},
      t.threshold, above(0));
}

/// A body that moves with inertia, and can be cut and torn.
struct MovingSpec : SolidSpec {
  Dynamic dynamic;  ///< defaults where the section is absent
  std::optional<Tearing> tearing;
};

/// Whether something acts on it all the time.
inline bool is_loaded(const MovingSpec& b) {
  return !b.dynamic.gravity.isZero(0) || !b.loads.empty();
}
inline void take_loads_off(MovingSpec& b) {
  b.dynamic.gravity.setZero();
  b.loads.clear();
}

inline void describe(Description& d, MovingSpec& b) {
  describe(d, static_cast<SolidSpec&>(b));
  d.table({"dynamic", "", "how it moves", Need::optional, Use::agreed, "defaults"}, b.dynamic);
  d.table({"tearing", "", "when it tears by itself", Need::optional, Use::agreed, "does not tear"}, b.tearing);
}

}  // namespace palpate

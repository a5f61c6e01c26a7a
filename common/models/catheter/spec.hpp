#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>

#include "common/fem/solid_spec.hpp"
#include "common/geometry/direction.hpp"
#include "common/models/kind.hpp"

namespace palpate {

/// How the chain of particles goes on by a step: at once at any stiffness, or by BHS01 eq. 28 in substeps.
enum class ChainIntegrator { implicit, semi_implicit };

inline const auto& words_of(ChainIntegrator) {
  static constexpr std::array<std::string_view, 2> words{"implicit", "semi_implicit"};
  return words;
}

/// A flexible catheter of particles (BHS01 sec. V-C-2), straight at rest.
struct Catheter {
  std::string inside;                              ///< name of the shell that it is led into; empty: none
  Eigen::Vector3d tail = Eigen::Vector3d::Zero();  ///< [m] first particle at rest
  Eigen::Vector3d tip = Eigen::Vector3d::UnitX();  ///< [m] last particle at rest
  double radius = 0.00125;                         ///< [m]
  int particles = 60;
  double sleeve = 0;                                  ///< [m] of a straight fixed sleeve, from `tail` towards `tip`
  double damping = 5;                                 ///< [1/s] force -damping m v on a particle
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s^2]
  ChainIntegrator integrator = ChainIntegrator::implicit;
};

inline void describe(Description& d, Catheter& c) {
  d.text({"inside", "",
          "the duct: a body of the model `\"modal_shell\"`, a tube with two open ends that is wider than the catheter"},
         c.inside);
  d.vector({"tail", "m", "first particle at rest", Need::required, Use::stored}, c.tail);
  d.vector({"tip", "m", "last particle at rest: what goes in first", Need::required, Use::stored}, c.tip);
  const double length = safe_length(c.tip - c.tail);
  d.require(length > 0, "tip", "the catheter's tail and tip must not coincide");
  d.number({"radius", "m", "of the tube", Need::optional, Use::stored}, c.radius, above(0));
  d.integer({"particles", "", "evenly along it", Need::optional, Use::stored}, c.particles, 4, 10000);
  d.number({"sleeve", "m", "of a straight fixed sleeve from `tail` towards `tip`, in which it slides"}, c.sleeve,
           at_least(0));
  d.require(c.sleeve < length, "sleeve",
            fmt::format("sleeve must be shorter than the catheter, which is {} m long, and is {}", length, c.sleeve));
  d.number({"damping", "1/s", "proportional to mass"}, c.damping, at_least(0));
  d.vector({"gravity", "m/s²", "acceleration of free fall"}, c.gravity);
  d.choice({"integrator", "",
            "`\"implicit\"`: stable at any stiffness; `\"semi_implicit\"`: the paper's, in as many substeps as the "
            "stiffness asks for"},
           c.integrator);
}

/// A thin flexible tube of particles. Stretching and bending follow from Young's modulus and the radius.
struct CatheterSpec : NamedSpec {
  static constexpr std::string_view kKind = "catheter";
  Material material{0, 0.45, 1000};
  Catheter catheter;
};

inline void describe(Description& d, CatheterSpec& b) {
  describe(d, static_cast<NamedSpec&>(b));
  d.number({"young", "Pa", "Young's modulus", Need::required}, b.material.young, kYoungRange);
  d.number({"poisson", "1", "Poisson's ratio"}, b.material.poisson, kPoissonRange);
  d.number({"density", "kg/m³", "mass per volume"}, b.material.density, kDensityRange);
  d.table({"catheter", "", "where it lies and what it is made of", Need::required, Use::stored}, b.catheter);
}

/// The tube about its particles at rest: a surface, and nothing else.
std::optional<Archive> made_archive(const CatheterSpec& body);

std::unique_ptr<BodyPart> make_haptic_part(const CatheterSpec& body, const Archive& archive,
                                           const StepSettings& settings);

std::unique_ptr<BodyShape> make_shape(const CatheterSpec& body, const Archive& archive, const StepSettings& settings);

ArchiveJob archive_job(const CatheterSpec& body, const Progress& progress);

constexpr bool has_task(const CatheterSpec&) {
  return true;
}
constexpr bool has_static_states(const CatheterSpec&) {
  return false;
}
constexpr std::string_view absence(const CatheterSpec&) {
  return "no catheter: no particles and no task record";
}
FreeVibration vibration(const CatheterSpec& body);
Appearance appearance(const CatheterSpec& body, const SurfaceMap& surface);

/// The duct must be a wall of the scene.
void require_neighbours(Description& d, const std::string& place, const CatheterSpec& body, const FindNeighbour& find);
void check_guest(const CatheterSpec& body, const ShellSpec& wall, const ShellMesh& mesh);

void check(const CatheterSpec& body, const CheckSettings& settings, CheckReport& report);

}  // namespace palpate

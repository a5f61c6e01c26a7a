#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "common/describe/meanings.hpp"
#include "common/fem/offline_spec.hpp"
#include "common/fem/relaxation_spec.hpp"
#include "common/fem/solid_spec.hpp"
#include "common/models/kind.hpp"

namespace palpate {

/// The correction follows curves that were measured on a specimen.
struct MeasuredLaw {
  static constexpr std::string_view kKind = "measured";
  static constexpr std::string_view kMeaning = "curves of a loading test of a specimen";
  std::filesystem::path force_curve;    ///< CSV `displacement_m,force_N`
  std::filesystem::path radial_curve;   ///< CSV `displacement_m,radial_m`
  double specimen_radius = 0;           ///< [m]
  double specimen_height = 0;           ///< [m]
  int degree = 6;                       ///< 4..10
  std::filesystem::path specimen_mesh;  ///< empty: ends slide, closed-form linear curves; else stuck ends
  double specimen_scale = 1;            ///< [m per unit of specimen_mesh]
};

inline void describe(Description& d, MeasuredLaw& n) {
  d.file({"force_curve", "", "axial force: CSV with the header `displacement_m,force_N`", Need::required},
         n.force_curve);
  d.file({"radial_curve", "", "radial displacement: CSV with the header `displacement_m,radial_m`", Need::required},
         n.radial_curve);
  d.number({"radius", "m", "radius of the specimen", Need::required}, n.specimen_radius, above(0));
  d.number({"height", "m", "height of the specimen", Need::required}, n.specimen_height, above(0));
  d.integer({"degree", "", "degree of the two fitted polynomials"}, n.degree, 4, 10);
  d.file(
      {"specimen_mesh", "",
       "mesh of the specimen, its axis along z: the linear curves come from pressing it with stuck ends. Absent, the "
       "ends slide and the closed forms are used",
       Need::optional, Use::stored},
      n.specimen_mesh);
  d.number({"specimen_scale", "m", "length of that mesh's unit", Need::optional, Use::stored}, n.specimen_scale,
           above(0));
  d.only_with("specimen_scale", "specimen_mesh");
}

/// The correction follows presses of the body itself, which are computed beforehand by linear and by neo-Hookean
/// elasticity.
struct NeoHookeanLaw {
  static constexpr std::string_view kKind = "neo_hookean";
  static constexpr std::string_view kMeaning = "presses of the body itself, computed with large strains and rotations";
  static constexpr int kMaxPlaces = 64;
  double ball_radius = 0.006;  ///< [m]
  int places = 8;
};

inline void describe(Description& d, NeoHookeanLaw& n) {
  d.number({"ball_radius", "m", "radius of the ball that presses: that of the tips that will touch the body",
            Need::optional, Use::stored},
           n.ball_radius, above(0));
  d.integer({"places", "",
             "number of places that it presses, spread over what can be touched; between them the "
             "correction goes over evenly",
             Need::optional, Use::stored},
            n.places, 1, NeoHookeanLaw::kMaxPlaces);
}

/// Quasi non-linear correction (TVCG99 sec. 3-4, 4-3).
struct Nonlinear {
  std::variant<MeasuredLaw, NeoHookeanLaw> law;
};

inline void describe(Description& d, Nonlinear& n) {
  static const std::string laws = meanings(std::type_identity<decltype(n.law)>{});
  d.variant({"law", "", laws}, n.law);
}

/// What the body says of such a law; null if it has none, or another.
template <class Law>
const Law* law_of(const std::optional<Nonlinear>& nonlinear) {
  return nonlinear ? std::get_if<Law>(&nonlinear->law) : nullptr;
}

/// Linear elasticity, solved beforehand (TVCG99 sec. 4).
struct QuasiStaticSpec : SolidSpec {
  static constexpr std::string_view kKind = "quasi_static";
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s^2]
  std::optional<Nonlinear> nonlinear;
  std::optional<Relaxation> relaxation;  ///< absent: forces do not depend on the rate
  std::optional<Offline> offline;        ///< absent: see offline_of()
};

inline void describe(Description& d, QuasiStaticSpec& b) {
  describe(d, static_cast<SolidSpec&>(b));
  describe_weight(d, b.gravity);
  d.table({"nonlinear", "", "the quasi non-linear correction", Need::optional, Use::agreed, "linear"}, b.nonlinear);
  d.table({"relaxation", "", "how its moduli fall with time", Need::optional, Use::agreed, "does not relax"},
          b.relaxation);
  d.require(!b.nonlinear || !b.relaxation, "relaxation",
            "[body.relaxation] does not go with [body.nonlinear], whose curves are those of one rate");
  d.table({"offline", "", "what the tensors are computed from", Need::optional, Use::stored,
           "quadratic elements, on a fine mesh linear ones"},
          b.offline);
}

/// What the tensors of a body are computed from: what it says, else quadratic elements, which bend as the tissue does
/// and are true near a tip; beyond kMaxQuadratic nodes of its surface linear ones, since the mesh is fine and they
/// would take minutes.
Offline offline_of(const QuasiStaticSpec& body, int surface_nodes);
/// Why it is that, in words; empty where the body says so itself.
std::string why_offline(const QuasiStaticSpec& body, int surface_nodes);
inline constexpr int kMaxQuadratic = 3000;
/// How tensors are stored: whole, or compressed, near blocks dense and far ones of low rank. Which
/// one follows from the number of touchable nodes.
enum class TensorForm { dense, compressed };
inline constexpr int kMaxDense = 2000;
constexpr TensorForm form_of(int touchable) {
  return touchable > kMaxDense ? TensorForm::compressed : TensorForm::dense;
}

ArchiveJob archive_job(const QuasiStaticSpec& body, const Progress& progress);

std::unique_ptr<BodyPart> make_haptic_part(const QuasiStaticSpec& body, const Archive& archive,
                                           const StepSettings& settings);

std::unique_ptr<BodyShape> make_shape(const QuasiStaticSpec& body, const Archive& archive,
                                      const StepSettings& settings);

inline bool stores_inertia(const QuasiStaticSpec& body) {
  return !body.gravity.isZero(0);
}

void check(const QuasiStaticSpec& body, const CheckSettings& settings, CheckReport& report);
std::vector<std::string> locking_warnings(const QuasiStaticSpec& body);
DirectProblem direct_problem(const QuasiStaticSpec& body);
FreeVibration vibration(const QuasiStaticSpec& body);
StaticCorrection static_correction(const QuasiStaticSpec& body);

}  // namespace palpate

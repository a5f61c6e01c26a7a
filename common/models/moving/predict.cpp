#include "common/models/moving/predict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "common/contact/patch/patch_parts.hpp"
#include "common/fem/body_loads.hpp"
#include "common/models/check/loads_check.hpp"
#include "common/models/moving/tissue_steps.hpp"
#include "common/models/moving/tried_contact.hpp"
#include "common/tool/instrument.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {
namespace {

constexpr int kTimed = 31;          // ticks whose median counts
constexpr int kTimedSteps = 30;     // of one of them at most: a tick of many more is a multiple
constexpr double kScripted = 1e-3;  // [s] between the places by which a motion's speed is told

/// A triangle of what moves, far from what holds the body.
std::array<int, 3> free_triangle(const ElasticMesh& mesh, const SurfaceMap& surface) {
  Eigen::Vector3d held = Eigen::Vector3d::Zero();
  int count = 0;
  std::vector<char> moves(mesh.nodes(), 0);
  for (const auto& t : mesh.tetrahedra)
    for (const int n : t) moves[n] = 1;
  for (int n = 0; n < mesh.nodes(); ++n)
    if (mesh.fixed[n][0] || mesh.fixed[n][1] || mesh.fixed[n][2]) held += mesh.rest[n], ++count;
  if (count > 0) held /= count;
  const auto distance = [&](const std::array<int, 3>& t) {
    const bool open = std::ranges::all_of(t, [&](int n) { return n < surface.touchable && moves[n]; });
    return open ? (mesh.rest[t[0]] - held).norm() : -1;
  };
  return *std::ranges::max_element(surface.triangles, {}, distance);
}

/// The scene's tools, of which one with a ball stands in a triangle by a part of its radius.
class StandingTool {
 public:
  StandingTool(std::span<const Tool> tools, const ElasticMesh& mesh, const SurfaceMap& surface) : all_(tools.size()) {
    const auto ball = std::ranges::find_if(tools, [](const Tool& t) { return abilities_of(t).ball.has_value(); });
    if (ball == tools.end()) return;
    const auto [a, b, c] = free_triangle(mesh, surface);
    const Eigen::Vector3d middle = (mesh.rest[a] + mesh.rest[b] + mesh.rest[c]) / 3;
    const Eigen::Vector3d normal = (mesh.rest[b] - mesh.rest[a]).cross(mesh.rest[c] - mesh.rest[a]).normalized();
    const double radius = abilities_of(*ball).radius;
    Eigen::Isometry3d pose(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), -normal));
    parts_ = tool_parts(*ball);
    ToolInTick& tool = all_[ball - tools.begin()];
    pose.translation() = middle + (1 + kMargin) * radius * normal;
    tool.moving = {pose, pose, parts_, parts_};
    tool.present = true;
    tool.moving.now.translation() -= (kMargin + kDepth) * radius * normal;
    active_ = &tool;
  }

  std::span<const ToolInTick> tools() const { return all_; }
  void stand() {
    if (active_) active_->moving.before = active_->moving.now;
  }

 private:
  static constexpr double kMargin = 0.05, kDepth = 0.2;  // of the radius
  std::vector<ToolPart> parts_;
  std::vector<ToolInTick> all_;
  ToolInTick* active_ = nullptr;
};

/// [s] the median of some ticks.
double cost_of_tick(DynamicOrgan& organ, StandingTool tools, double dt) {
  std::vector<double> taken;
  for (int i = 0; i < kTimed; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    organ.tick(tools.tools(), dt);
    taken.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    tools.stand();
  }
  const auto middle = taken.begin() + kTimed / 2;
  std::ranges::nth_element(taken, middle);
  return *middle;
}

/// How many times as stiff the tissue may be for its steps to fit: they grow with the root of its stiffness.
double fitting_stiffness(const MovingSpec& body, double frequency_bound, double dt, double cost) {
  Dynamic motion = body.dynamic;
  motion.step = 0;
  const auto fits = [&](double times) {
    return steps_in(dt, tissue_steps(body.name, motion, std::sqrt(times) * frequency_bound).touched) * cost <=
           kTissueShare * dt;
  };
  double within = 1e-12, beyond = 1e12;
  if (!fits(within)) return 0;
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(within * beyond);
    (fits(middle) ? within : beyond) = middle;
  }
  return within;
}

double max_speed(const Tool& tool, const Trajectory& script) {
  const Trocar trocar = make_trocar(tool.pivot, tool.axis, tool.up);
  double fastest = 0;
  Eigen::Vector3d before = tip_pose(trocar, script.at(0)).translation();
  for (int i = 1; i * kScripted <= script.duration(); ++i) {
    const Eigen::Vector3d now = tip_pose(trocar, script.at(i * kScripted)).translation();
    fastest = std::max(fastest, (now - before).norm() / kScripted);
    before = now;
  }
  return fastest;
}

// How contact with a body is not that of the stability cases; empty: it is.
std::string untried(const MovingSpec& body, const MovingKind& kind, const ContactSpec& contact) {
  if (contact.rule != ContactRule::patch) return fmt::format("under rule \"{}\"", word_of(contact.rule));
  if (!kind.contact_tried) return fmt::format("with a {} body", kind.name);
  if (body.dynamic.corotational) return "with elements that turn with the tissue";
  return {};
}

}  // namespace

void say_steps(const MovingSpec& body, DynamicOrgan& organ, const Archive& archive, const CheckSettings& settings,
               CheckReport& report) {
  const double frequency = organ.model().frequency_bound(), dt = settings.dt;
  const TissueSteps steps = tissue_steps(body.name, body.dynamic, frequency);
  report.say(
      fmt::format("  step: stable up to {:.4g} s, for frequencies up to {:.4g} rad/s; {}", steps.bound, frequency,
                  body.dynamic.step > 0 ? fmt::format("{} s is taken", body.dynamic.step) : "one below is taken"));
  const double timed = std::min(dt, kTimedSteps * steps.touched);
  const double part = cost_of_tick(organ, StandingTool(settings.tools, organ.mesh(), archive.surface), timed);
  const bool touched = !organ.contacts().empty();
  const double tick = part * organ.steps_in(dt, touched) / organ.steps_in(timed, touched);
  const int under_tools = steps_in(dt, steps.touched);
  report.say(fmt::format("  cost: {} steps a tick, {} under tools; a tick{} takes {:.2g} ms of {:.3g} on this machine",
                         steps_in(dt, steps.free), under_tools, touched ? " with a tip in the tissue" : "", 1e3 * tick,
                         1e3 * dt));
  const double fitting = fitting_stiffness(body, frequency, dt, tick / organ.steps_in(dt, touched));
  const std::string young =
      fmt::format("{:.2g} times as stiff (young = {:.2g} Pa)", fitting, fitting * body.material.young);
  const bool fits = tick <= kTissueShare * dt;
  if (fits && body.dynamic.step == 0) report.say("  fits a tick: up to " + young);
  if (fits) return;
  const std::string what = fitting >= 1  ? "a larger `step`"  // the scene's own asks for more than the tissue does
                           : fitting > 0 ? "tissue " + young
                                         : "no tissue at all on this mesh";
  report.warnings.push_back(
      fmt::format("body '{}': a tick takes {:.3g} ms where {:.3g} of {:.3g} ms are the tissue's: time in the tissue "
                  "falls behind; what would fit is {}, a coarser mesh or a lower haptic_hz",
                  body.name, 1e3 * tick, 1e3 * kTissueShare * dt, 1e3 * dt, what));
}

void say_sag(const MovingSpec& body, const StaticProblem& problem, CheckReport& report) {
  if (!is_loaded(body)) return;
  StaticLoads loads = body_loads(body, problem.mesh);
  loads.gravity = body.dynamic.gravity;
  const std::vector<Eigen::Vector3d> u = solve_direct(problem, {}, loads).displacement;
  const auto most = std::ranges::max_element(u, {}, [](const Eigen::Vector3d& x) { return x.norm(); });
  Eigen::Vector3d low = problem.mesh.nodes[0], high = low;
  for (const Eigen::Vector3d& p : problem.mesh.nodes) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const bool linear = problem.materials.nodal_strain.empty();
  say_sag(body.name, {most->norm(), static_cast<int>(most - u.begin()), (high - low).norm()},
          linear ? ", by linear elements" : ", by its own elements", report);
}

void say_tried_contact(const MovingSpec& body, const MovingKind& kind, const CheckSettings& settings, double edge,
                       int steps, CheckReport& report) {
  using Tried = TriedContact;
  if (const std::string what = untried(body, kind, settings.contact); !what.empty())
    return report.say(fmt::format("  stable contact: not tried {}: try it by palpate stability SCENE", what));
  report.say(
      body.dynamic.element == TetElement::nodal_strain
          ? "  stable contact of tips: with strain averaged at the nodes not of all (docs/stability.md)"
          : fmt::format("  stable contact of tips: tried from {:g} to {:g} Pa, Poisson's ratio up to {:g}, edges "
                        "of {:g} to {:g} mm, tips of {:g} to {:g} edges, {:g} radii deep, friction up to {:g}, "
                        "{:g} m/s, {:g} steps a tick",
                        Tried::kMinYoung, Tried::kMaxYoung, Tried::kMaxPoisson, 1e3 * Tried::kMinCell,
                        1e3 * Tried::kMaxCell, Tried::kMinRadius, Tried::kMaxRadius, Tried::kMaxDepth,
                        Tried::kMaxFriction, Tried::kMaxSpeed, Tried::kMaxSteps));
  const auto look = [&](const std::string& whose, double value, double low, double high, const char* unit) {
    if (value >= low && value <= high) return;
    report.warnings.push_back(
        fmt::format("body '{}': {} is {:.3g}{}, and contact with moving tissue was found stable from {:g} to {:g}{} "
                    "(docs/stability.md): try it by palpate stability SCENE",
                    body.name, whose, value, unit, low, high, unit));
  };
  look("young", body.material.young, Tried::kMinYoung, Tried::kMaxYoung, " Pa");
  for (const MaterialRegion& region : body.materials)
    look("young of a region", region.material.young, Tried::kMinYoung, Tried::kMaxYoung, " Pa");
  look("poisson", body.material.poisson, 0, Tried::kMaxPoisson, "");
  for (const MaterialRegion& region : body.materials)
    look("poisson of a region", region.material.poisson, 0, Tried::kMaxPoisson, "");
  look("the mean edge", edge, Tried::kMinCell, Tried::kMaxCell, " m");
  look("friction", settings.contact.friction, 0, Tried::kMaxFriction, "");
  look("the number of steps a tick", steps, 1, Tried::kMaxSteps, "");
  for (const PatchPart& part : patch_parts(settings.tools, true))
    if (part.length > 0)
      look(fmt::format("the shaft of '{}' over the mean edge", settings.tools[part.tool].name), part.radius / edge, 0,
           Tried::kMaxShaft, "");
  for (const Tool& tool : settings.tools) {
    if (abilities_of(tool).ball)
      look(fmt::format("the tip of '{}' over the mean edge", tool.name), abilities_of(tool).radius / edge,
           Tried::kMinRadius, Tried::kMaxRadius, "");
    if (const std::optional<Trajectory> script = settings.script(tool))
      look(fmt::format("the largest speed of '{}'", tool.name), max_speed(tool, *script), 0, Tried::kMaxSpeed, " m/s");
  }
}

}  // namespace palpate

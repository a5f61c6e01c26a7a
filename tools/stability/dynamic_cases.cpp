// Steps, damping and cuts of moving tissue; fitted curves beyond their data.
#include <fmt/format.h>

#include <cmath>

#include "common/models/quasi_static/fitted_curve.hpp"
#include "tools/rig/example_bodies.hpp"
#include "tools/rig/kinds.hpp"
#include "tools/rig/press_rig.hpp"
#include "tools/stability/press.hpp"
#include "tools/stability/watch.hpp"

namespace palpate::stability {
namespace {

using Eigen::Vector3d;

/// A block of moving tissue of one kind.
struct Tissue {
  Scene scene;
  bool of_elements;  ///< which can turn with the tissue
};
std::vector<Tissue> tissues() {
  return {{moving_block_scene<TensorMassSpec>(), true}, {moving_block_scene<SpringMassSpec>(), false}};
}

constexpr Precision kPrecisions[] = {Precision::float32, Precision::float64};

double bound_of(const Scene& scene, const Archive& archive) {
  const Body& body = scene.bodies[0];
  const Dynamic& motion = motion_of(body);
  const auto model = make_model(body, elastic_mesh(archive));
  return max_step(motion.integrator, model->frequency_bound(), motion.damping);
}

/// [1] What the energy of plucked tissue may come to, of what it was: RK4 lets none grow but by rounding; that of
/// semi-implicit steps swings about its mean, the more the nearer the step is to its bound.
double bound_of_energy(Integrator integrator) {
  return integrator == Integrator::rk4 ? 1 + 1e-9 : 2;
}

/// Free motion from a pluck at one step size: the energy of the undamped tissue may not grow.
Result pluck(const Scene& scene, double step, int count) {
  const Archive archive = precompute_on(scene.bodies[0], small_block_mesh());
  const double bound = bound_of(scene, archive);
  Scene asked = scene;
  moving_block_of(asked).dynamic.step = step;
  (void)PressRig(asked, {archive});  // refuses beyond the bound
  const auto model = make_model(scene.bodies[0], elastic_mesh(archive));
  double strongest = 0, first = 0, last = 0;
  for (int n = 0; n < model->nodes(); ++n)
    if (model->mass(n) > 0)
      model->set_motion(n, Vector3d::Zero(), Vector3d(1e-3 * std::sin(1.7 * n), 1e-3 * std::cos(2.3 * n), 1e-3));
  first = model->energy();
  for (int i = 0; i < count; ++i) {
    model->step(step);
    last = larger(last, model->energy());
  }
  for (int n = 0; n < model->nodes(); ++n) strongest = larger(strongest, model->elastic_force(n).norm());
  Result r{.max_force = strongest,
           .energy_growth = last - first,
           .note = fmt::format("bound {:.3g} s; energy is the tissue's own, {:.3g} J at first", bound, first)};
  hold(r, "energy, of that at first", last / first, bound_of_energy(motion_of(scene.bodies[0]).integrator));
  return r;
}

}  // namespace

std::vector<Point> dynamic_points(const Extent& extent) {
  std::vector<Point> points;
  for (const Tissue& tissue : tissues())
    for (const Integrator integrator : {Integrator::rk4, Integrator::semi_implicit})
      for (const bool corotational : {false, true}) {
        if (corotational && (!tissue.of_elements || extent.quick)) continue;
        Scene scene = tissue.scene;
        Dynamic& motion = moving_block_of(scene).dynamic;
        motion.integrator = integrator;
        motion.damping = 0;
        motion.precision = Precision::float64;
        motion.corotational = corotational;
        const std::string name = fmt::format("step {} {}{}", kind_of(scene.bodies[0]), word_of(integrator),
                                             corotational ? " corotational" : "");
        for (double s : extent.quick ? std::vector{0.9, 1.5} : std::vector{0.1, 0.5, 0.9, 0.999, 1.001, 1.5, 3.0, 10.0})
          points.push_back({name, "step / bound [1]", fmt::format("{:g}", s), [scene, s, extent, corotational] {
                              return pluck(scene,
                                           s * bound_of(scene, precompute_on(scene.bodies[0], small_block_mesh())),
                                           extent.quick   ? 500
                                           : corotational ? 2000
                                                          : 20000);
                            }});
        if (!extent.quick) points.push_back({name, "step [s]", "1e-7", [scene] { return pluck(scene, 1e-7, 2000); }});
      }
  for (double a : extent.quick ? std::vector{0.0, 1e4} : std::vector{0.0, 1e-3, 1.0, 60.0, 1e3, 1e4, 1e6})
    for (const Integrator integrator : {Integrator::rk4, Integrator::semi_implicit})
      points.push_back({fmt::format("damping {}", word_of(integrator)), "damping [1/s]", fmt::format("{:g}", a), [=] {
                          Scene scene = moving_block_scene();
                          moving_block_of(scene).dynamic.damping = a;
                          moving_block_of(scene).dynamic.integrator = integrator;
                          return press_tissue(scene, small_block_mesh(), 0.004, extent.quick ? 100 : 1000);
                        }});
  for (double e : extent.quick ? std::vector{1.0} : std::vector{1.0, 1e3, 1e6, 1e8})
    for (const Precision precision : kPrecisions)
      points.push_back({fmt::format("young moving {}", word_of(precision)), "E [Pa]", fmt::format("{:g}", e),
                        [=] {
                          Scene scene = moving_block_scene();
                          moving_block_of(scene).material.young = e;
                          moving_block_of(scene).dynamic.precision = precision;
                          return press_tissue(scene, small_block_mesh(), 0.004, 100);
                        },
                        120});
  for (double d : extent.quick ? std::vector{1e-12, 0.019} : std::vector{1e-12, 1e-6, 1e-3, 0.01, 0.019, 0.03})
    points.push_back({"press moving", "depth [m] of 0.02", fmt::format("{:g}", d),
                      [=] { return press_tissue(moving_block_scene(), small_block_mesh(), d, 300); }});
  return points;
}

std::vector<Point> cut_points(const Extent& extent) {
  std::vector<Point> points;
  for (const Tissue& tissue : tissues()) {
    if (extent.quick && !tissue.of_elements) continue;
    const Scene& whole = tissue.scene;
    const std::string_view kind = kind_of(whole.bodies[0]);
    points.push_back({fmt::format("cut down {}", kind), "tetrahedra left", "1 and 0", [body = whole.bodies[0]] {
                        const Archive archive = precompute_on(body, small_block_mesh(2));
                        const Dynamic& motion = motion_of(body);
                        const auto tissue = make_model(body, elastic_mesh(archive));
                        const double step = 0.5 * max_step(motion.integrator, tissue->frequency_bound(), 60);
                        const int count = elastic_mesh(archive).tetrahedra.size();
                        Result r{.note = {}};
                        for (int t = count - 1; t >= 0; --t) {
                          tissue->remove(std::array{t});
                          for (int i = 0; i < 20; ++i) tissue->step(step);
                          for (int n = 0; n < tissue->nodes(); ++n) {
                            if (tissue->mass(n) > 0)
                              tissue->set_motion(n, 1e-4 * Vector3d(n % 3, n % 5, n % 2), Vector3d::Zero());
                            r.max_force = larger(r.max_force, tissue->elastic_force(n).norm());
                            if (!tissue->displacement(n).allFinite()) r.outcome = Outcome::failed;
                          }
                          if (!std::isfinite(tissue->energy())) r.outcome = Outcome::failed;
                        }
                        r.note = fmt::format("{} tetrahedra taken one by one, the last one too", count);
                        return r;
                      }});
    points.push_back(
        {fmt::format("cut away {}", kind), "by", "cautery through the whole block", [scene = whole]() mutable {
           std::get<ProbeSpec>(scene.tools[0].end).cautery = Cautery{.radius = 0.008};
           const auto path = [](int i) {
             return Vector3d(0.022 * std::sin(0.05 * i), 0.022 * std::sin(0.0613 * i), 0.028 - 0.03 * i / 1500);
           };
           const PressedTissue pressed = press_tissue(scene, small_block_mesh(), path, 1500, true);
           Result r = pressed.result;
           r.note += fmt::format("; {} of {} tetrahedra gone", pressed.removed, pressed.tetrahedra);
           return r;
         }});
  }
  points.push_back({"cut under load", "by", "cautery beside a tip that stands", [] {
                      Scene scene = moving_block_scene();
                      scene.tools.push_back(scene.tools[0]);
                      std::get<ProbeSpec>(scene.tools[1].end).cautery = Cautery{.radius = 0.004};
                      PressRig rig(scene, {precompute_on(scene.bodies[0], small_block_mesh(8))});
                      TissueWatch watch;
                      for (int i = 0; i < 1500; ++i) {
                        const double down = std::min(1.0, i / 200.0), across = std::clamp((i - 400) / 1000.0, 0.0, 1.0);
                        ToolDofs cutting = tip_at(scene.tools[1], {0.03 - 0.06 * across, 0.004, 0.021});
                        cutting.pedal = i > 400;
                        rig.press(std::array{tip_at(scene.tools[0], {0, -0.004, 0.0262 - 0.004 * down}), cutting});
                        watch.look(rig.organ(), work_on(rig.tissue(), 0));
                      }
                      Result r = watch.result();
                      r.note += fmt::format("; {} of {} tetrahedra gone", rig.organ().removed().size(),
                                            rig.organ().mesh().tetrahedra.size());
                      return r;
                    }});
  for (double threshold : extent.quick ? std::vector{0.05} : std::vector{1e-6, 1e-3, 0.05, 0.5})
    points.push_back({"tearing", "volume change [1]", fmt::format("{:g}", threshold), [=] {
                        Scene scene = moving_block_scene();
                        moving_block_of(scene).tearing =
                            Tearing{.criterion = TearCriterion::volume, .threshold = threshold};
                        const auto path = [](int i) {
                          return Vector3d(0.002 * std::sin(0.1 * i), 0, 0.0262 - 0.012 * std::min(1.0, i / 200.0));
                        };
                        const PressedTissue pressed = press_tissue(scene, small_block_mesh(), path, 400);
                        Result r = pressed.result;
                        r.note +=
                            fmt::format("; a cascade of {} of {} tetrahedra", pressed.removed, pressed.tetrahedra);
                        return r;
                      }});
  return points;
}

std::vector<Point> curve_points(const Extent& extent) {
  std::vector<Point> points;
  for (int degree : extent.quick ? std::vector{10} : std::vector{4, 6, 8, 10})
    for (double beyond : extent.quick ? std::vector{1e6} : std::vector{1.0, 1.5, 10.0, 1e6})
      points.push_back(
          {fmt::format("curve degree {}", degree), "press / end of the data [1]", fmt::format("{:g}", beyond), [=] {
             std::vector<double> s, f;
             for (int i = 1; i <= 40; ++i) {
               s.push_back(0.01 * i / 40);
               f.push_back(0.3 * (std::exp(3.0 * i / 40) - 1) * (1 + 1e-3 * std::sin(7 * i)));
             }
             const FittedCurve curve(s, f, degree);
             const double fall = curve.first_fall();
             if (fall >= 0) throw std::runtime_error(fmt::format("the force falls from {:.3g} m on", fall));
             const double x = 0.01 * beyond, y = curve.value(x);
             Result r{.max_force = y,
                      .note = fmt::format("slope {:.3g} N/m, at the end {:.3g}", curve.slope(x), curve.slope(0.01))};
             if (!(curve.slope(x) > 0) ||
                 !(std::abs(y - curve.value(0.01) - curve.slope(0.01) * (x - 0.01)) <= 1e-9 * std::abs(y)))
               r.outcome = Outcome::failed;
             return r;
           }});
  points.push_back({"curve", "data", "a force that falls", [] {
                      std::vector<double> s, f;
                      for (int i = 1; i <= 20; ++i) {
                        s.push_back(1e-3 * i);
                        f.push_back(std::sin(0.2 * i));
                      }
                      const FittedCurve curve(s, f, 6);
                      if (curve.first_fall() >= 0)
                        throw std::runtime_error(fmt::format("the force falls from {:.3g} m on", curve.first_fall()));
                      return Result{.outcome = Outcome::failed, .note = "a falling force was taken"};
                    }});
  return points;
}

}  // namespace palpate::stability

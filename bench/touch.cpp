// What does the hand feel of the mesh? A ball led over the example's liver and over a block, stabbed in, over an edge,
// beside another one; and its force against Hertz's from coarse to fine triangles.
#include <cmath>
#include <map>
#include <numbers>

#include "bench/report.hpp"
#include "bench/touch_block.hpp"
#include "common/fem/processor_blas.hpp"
#include "common/fem/refine_graded.hpp"
#include "common/scene/ensure_archive.hpp"
#include "tools/rig/slide.hpp"
#include "tools/study/ball_press.hpp"
#include "tools/study/kinds.hpp"
#include "tools/study/slides.hpp"

namespace palpate {
namespace {

using bench::hertz;
using bench::kTipRadius;
using Eigen::Vector3d;

constexpr double kDepth = 0.004;  // [m] into the liver
constexpr double kFriction[] = {0, 0.3};

void row(std::string_view name, std::string_view metric, double value, std::string_view unit = "1") {
  bench::report("touch", name, metric, value, unit);
}

std::string with_friction(const char* name, double friction) {
  return friction > 0 ? name : std::string(name) + "_frictionless";
}

void report_slide(const std::string& name, const SlideMeasures& m) {
  row(name, "mean", m.mean, "N");
  row(name, "ripple", m.ripple);
  row(name, "jump", m.jump);
  row(name, "turn", m.turn);
  row(name, "buzz", m.buzz);
}

/// The liver of the example scene, its archive, and the solutions that it is compared with.
struct Liver {
  Scene scene = load_scene(PALPATE_SCENES "/liver.toml");
  std::vector<Archive> archives = load_or_precompute(scene, ArchivePart::surface);
  study::SolidCase solid;

  explicit Liver(bool quick) : solid(scene, 0, *study::on_one_mesh(scene.bodies[0]), quick) {}
  double radius() const { return solid.presses().radius; }
  PressRig rig(double friction, int balls = 1) const {
    Scene alone = solid.press_scene(scene, 0);
    alone.contact.friction = friction;
    alone.tools.resize(balls, alone.tools[0]);
    for (int t = 1; t < balls; ++t) alone.tools[t].name += std::to_string(t);
    return {alone, archives};
  }
};

void slide_liver(Liver& liver) {
  for (const double friction : kFriction) {
    PressRig rig = liver.rig(friction);
    const auto ticks = slide(rig, liver.solid.slide_path(), liver.radius(), kDepth);
    const auto& reference = liver.solid.slide_reference(kDepth);
    report_slide(with_friction("slide_liver_4mm", friction),
                 measure_slide(ticks, std::span(reference).last(ticks.size()), rig.dt()));
  }
  std::vector<double> shares;
  for (int p = 0; p < static_cast<int>(liver.solid.presses().patches.size()); ++p) {
    study::BallPress press(liver.solid.press_scene(liver.scene, p), liver.archives[0], liver.solid.presses().patches[p],
                           liver.radius());
    const auto around = study::press_around(liver.solid, p, press.rig());
    shares.insert(shares.end(), around.begin(), around.end());
  }
  row("press_liver_3mm", "spread", spread_of(shares));
}

/// In at 1 m/s to the depth of the slides and out again, beside the force that slow presses have at the same depths.
void stab_liver(Liver& liver) {
  const study::Patch& place = liver.solid.presses().patches[0];
  const auto at = [&](double depth) { return centre_at(place, liver.radius(), depth); };
  PressRig fast = liver.rig(0.3), slow = liver.rig(0.3);
  fast.start(at(-0.01));
  slow.start(at(-0.01));
  const double full = 0.001;  // [m] a tick
  double beyond = 0, first = 0, before = 0, jump = 0, depth = -0.01;
  for (int i = 0; i < 28; ++i) {
    const double next = depth + (i < 14 ? full : -full);
    for (int k = 1; k <= 50; ++k) slow.press(at(depth + (next - depth) * k / 50));
    fast.press(at(next));
    depth = next;
    const double now = fast.force().norm();
    beyond = std::max(beyond, (fast.force() - slow.force()).norm());
    jump = std::max(jump, std::abs(now - before));
    if (first == 0) first = now;
    before = now;
  }
  PressRig deep = liver.rig(0.3);
  deep.start(at(-0.01));
  for (int k = 1; k <= 700; ++k) deep.press(at(-0.01 + 2e-5 * k));
  const double most = deep.force().norm();
  row("stab_liver_1m_s", "jump", jump / most);
  row("stab_liver_1m_s", "beyond_depth", beyond / most);
}

/// Comes to the surface and leaves it at the speed of the slides: the largest force of a first or last tick in contact.
void onset_liver(Liver& liver) {
  const study::Patch& place = liver.solid.presses().patches[0];
  for (const double friction : kFriction) {
    PressRig rig = liver.rig(friction);
    const auto at = [&](double depth) { return centre_at(place, liver.radius(), depth); };
    rig.start(at(-0.001));
    double before = 0, most = 0, edge = 0, jump = 0, change = 0;
    for (int i = 0; i <= 2000; ++i) {
      rig.press(at(-0.001 + (kDepth + 0.001) * std::pow(std::sin(M_PI * i / 2000), 2)));
      const double now = rig.force().norm();
      if ((before == 0) != (now == 0)) edge = std::max(edge, std::max(before, now));
      jump = std::max(jump, std::abs((now - before) - change));
      change = now - before;
      most = std::max(most, now);
      before = now;
    }
    const std::string name = with_friction("press_liver_4mm", friction);
    row(name, "onset", edge / most);
    row(name, "kink", jump / most);
  }
}

/// Two balls that are led towards each other over the liver until they nearly meet.
void two_balls(Liver& liver) {
  const auto& middle = liver.solid.slide_path().places[liver.solid.slide_path().places.size() / 2];
  const SurfacePath path =
      surface_path(liver.archives[0].surface, middle,
                   {.length = 9 * liver.radius(), .run_up = 0, .step = 5e-5, .clear = liver.radius()});
  const double depth = kDepth;
  PressRig rig = liver.rig(0.3, 2);
  const auto tips = [&](std::size_t i, double at) {
    return std::array{
        tip_at(rig.scene().tools[0], centre_at(path.places[i], liver.radius(), at)),
        tip_at(rig.scene().tools[1], centre_at(path.places[path.places.size() - 1 - i], liver.radius(), at))};
  };
  const auto apart = [&](std::size_t i) {
    return (centre_at(path.places[i], liver.radius(), depth) -
            centre_at(path.places[path.places.size() - 1 - i], liver.radius(), depth))
        .norm();
  };
  rig.start(tips(0, -0.001));
  for (int k = 0; k <= 200; ++k) rig.press(tips(0, -0.001 + (depth + 0.001) * k / 200));
  double jump = 0, mean = 0;
  int count = 0;
  std::array<double, 2> before{};
  for (std::size_t i = 1; i < path.places.size() / 2 && apart(i) > 2.05 * liver.radius(); ++i) {
    rig.press(tips(i, depth));
    for (int t = 0; t < 2; ++t) {
      const double now = rig.haptic().force(t).norm();
      if (i > 1) jump = std::max(jump, std::abs(now - before[t]));
      before[t] = now;
      mean += now;
      ++count;
    }
  }
  row("two_balls_liver_4mm", "jump", jump * count / mean);
  row("two_balls_liver_4mm", "way", path.step * count / 2, "m");
}

/// A ball that leaves the top of a block over its edge, at a constant height.
void cross_edge(const Archive& archive) {
  for (const double friction : kFriction) {
    PressRig rig(bench::touch_scene(bench::touch_block(), friction), {archive});
    const double half = 8 * kTipRadius, depth = kTipRadius / 2;
    const auto at = [&](double x, double d) { return Vector3d(x, 0.003, kTipRadius - d); };
    double x = half - 4 * kTipRadius;
    rig.start(at(x, -0.001));
    for (int k = 0; k <= 200; ++k) rig.press(at(x, -0.001 + (depth + 0.001) * k / 200));
    const double begin = rig.force().norm();
    double before = begin, jump = 0, where = 0;
    for (; x < half + 1.5 * kTipRadius; x += kSlideSpeed * rig.dt()) {
      rig.press(at(x, depth));
      const double now = rig.force().norm();
      if (std::abs(now - before) > jump) jump = std::abs(now - before), where = x - half;
      before = now;
    }
    const std::string name = with_friction("edge_block", friction);
    row(name, "jump", jump / begin);
    row(name, "jump_beyond_edge", where / kTipRadius, "R");
    row(name, "left", before / begin);
  }
}

void slide_block(const Archive& archive, const std::string& of) {
  const int middle = nearest_triangle(archive.surface, Vector3d::Zero());
  const auto places = places_in(archive.surface, middle);
  const SurfacePath path = surface_path(
      archive.surface, places[0], {.length = 6 * kTipRadius, .run_up = kTipRadius, .step = 5e-5, .clear = kTipRadius});
  for (const double friction : kFriction) {
    PressRig rig(bench::touch_scene(bench::touch_block(), friction), {archive});
    const auto ticks = slide(rig, path, kTipRadius, kTipRadius / 2);
    report_slide(with_friction(("slide_block_" + of).c_str(), friction),
                 measure_slide(ticks, line_through(ticks), rig.dt()));
  }
  PressRig rig(bench::touch_scene(bench::touch_block(), 0), {archive});
  rig.start(centre_at(places[0], kTipRadius, -kTipRadius / 2));
  row("press_block_" + of, "spread", spread_of(press_places(rig, places, kTipRadius, kTipRadius / 2)));
}

/// [N] of linear elements on the block at a depth [m], edges of `share` of the contact's radius under the tip.
double block_force(double depth, double share) {
  const StaticProblem coarse = make_static_problem(bench::touch_block(), bench::block_of_edges(4 * kTipRadius));
  const double contact = std::sqrt(kTipRadius * depth);
  const auto size = [&](const Vector3d& x) {
    return std::min(4 * kTipRadius,
                    size_around(x, Vector3d::Zero(), Vector3d::UnitZ(), contact, share * contact, 2 * share));
  };
  const LinearContact reference(refine_graded(coarse, size, 100000), std::array{Vector3d(Vector3d::Zero())},
                                1.15 * contact);
  return reference.press({{0, 0, kTipRadius - depth}, kTipRadius}).force.norm();
}

/// [N] of the converged solution, as a study extrapolates it.
double block_reference(double depth, bool quick) {
  const double share = quick ? 0.2 : 0.12;
  return 2 * block_force(depth, share) - block_force(depth, std::numbers::sqrt2 * share);
}

constexpr double kHertzDepths[] = {kTipRadius / 4, kTipRadius / 2};

std::string name_of_depth(double depth) {
  return fmt::format("R{:.0f}", kTipRadius / depth);
}

/// Presses at four places of a triangle, from edges of two radii to an eighth of one.
void hertz_over_edges(bool quick) {
  std::map<double, double> reference;
  for (const double depth : kHertzDepths) {
    reference[depth] = block_reference(depth, quick);
    row("hertz_reference", name_of_depth(depth), reference[depth] / hertz(depth), "Hertz");
  }
  for (const double per_edge : {0.5, 1.0, 2.0, 4.0, 8.0}) {
    if (quick && per_edge > 1) break;
    const double h = kTipRadius / per_edge;
    QuasiStaticSpec block = bench::touch_block();
    if (per_edge > 2) block.offline = Offline{};  // linear elements are good enough, and quadratic ones too many
    const double reach = 1.3 * kTipRadius + 2 * h;
    block.touchable =
        NodeSelector{{.indices = {}, .box = Box{{-reach, -reach, -1e-6}, {reach, reach, 1}}, .group = {}}};
    const auto begin = std::chrono::steady_clock::now();
    const Archive archive = precompute(block, bench::block_of_edges(h));
    fmt::print(stderr, "R/h = {}: {} touchable nodes, {:.1f} s\n", per_edge, archive.surface.touchable,
               std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    for (const double depth : kHertzDepths) {
      std::vector<double> shares;
      for (const Vector3d& place :
           {Vector3d(0, 0, 0), Vector3d(0.25, 0.1, 0), Vector3d(0.5, 0.25, 0), Vector3d(0.5, 0.5, 0)}) {
        PressRig rig(bench::touch_scene(block, 0), {archive});
        const SurfacePlace at{h * place, -Vector3d::UnitZ(), 0};
        rig.start(centre_at(at, kTipRadius, -0.5 * kTipRadius));
        shares.push_back(press_places(rig, {&at, 1}, kTipRadius, depth)[0] / reference[depth]);
      }
      const auto [least, most] = std::ranges::minmax(shares);
      const std::string name = fmt::format("hertz_R_over_h_{}", per_edge);
      row(name, name_of_depth(depth) + "_least", least, "reference");
      row(name, name_of_depth(depth) + "_most", most, "reference");
    }
  }
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::use_blas_of_this_processor(argv);
  using namespace palpate;
  const bool quick = bench::quick(argc, argv);
  Liver liver(quick);
  slide_liver(liver);
  onset_liver(liver);
  stab_liver(liver);
  two_balls(liver);
  const TetMesh mesh = bench::block_of_edges(2 * kTipRadius);
  const Archive block = precompute(bench::touch_block(), mesh);
  slide_block(block, "p2");
  cross_edge(block);
  if (!quick) slide_block(precompute(bench::touch_block(1), mesh), "p2_refine1");
  hertz_over_edges(quick);
}

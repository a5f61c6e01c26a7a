// What does the hand feel of the mesh under a shaft that is laid on a block? From coarse to fine triangles, by the
// patch rule and by contact of the mesh's points.
#include <array>
#include <cmath>

#include "bench/report.hpp"
#include "bench/shaft_block.hpp"
#include "tools/rig/slide.hpp"

namespace palpate {
namespace {

using bench::kShaftRadius;
using bench::shaft_tip;

constexpr double kSpeed = 0.05;  // [m/s]
constexpr double kDepths[] = {kShaftRadius / 4, kShaftRadius / 2};

void row(const std::string& name, std::string_view metric, double value, std::string_view unit) {
  bench::report("shaft", name, metric, value, unit);
}

/// [N] down at places across, each come to from above.
std::vector<double> presses(PressRig& rig, std::span<const double> aside, double depth) {
  std::vector<double> forces;
  for (const double y : aside) {
    rig.press(shaft_tip(y, 0, -0.5 * kShaftRadius));
    for (int i = 0; i <= 60; ++i)
      rig.press(shaft_tip(y, 0, -0.5 * kShaftRadius + (depth + 0.5 * kShaftRadius) * i / 60));
    for (int i = 0; i < 30; ++i) rig.press(shaft_tip(y, 0, depth));
    forces.push_back(-rig.force().z());
  }
  return forces;
}

struct Way {
  const char* name;
  double aside, along;
};

/// At a constant depth, over four radii.
SlideMeasures slide(PressRig& rig, const Way& way, double depth) {
  std::vector<SlideTick> ticks;
  const double step = kSpeed * rig.dt(), run_up = 0.5 * kShaftRadius, length = 2 * kShaftRadius;
  const auto tip = [&](double path, double deep) {
    return shaft_tip(way.aside * (path - 0.5 * length), way.along * (path - 0.5 * length), deep);
  };
  for (double deep = -0.1 * kShaftRadius; deep < depth; deep += step) rig.press(tip(-run_up, deep));
  for (double path = -run_up; path < length; path += step) {
    rig.press(tip(path, depth));
    const Eigen::Vector3d f = rig.force();
    ticks.push_back({path, f.norm(), -(way.along * f.x() + way.aside * f.y())});
  }
  return measure_slide(ticks, line_through(ticks), rig.dt());
}

void measure(double per_edge, ContactRule rule, std::span<const double> reference) {
  const double h = kShaftRadius / per_edge;
  const Archive archive = precompute(bench::shaft_block(), bench::shaft_block_of_edges(h));
  const std::string name = fmt::format("{}_R_over_h_{}", word_of(rule), per_edge);
  std::vector<double> aside;
  for (const double share : {0.0, 0.2, 0.4, 0.6, 0.8}) aside.push_back(share * std::min(h, kShaftRadius));
  for (int d = 0; d < 2; ++d) {
    PressRig rig(bench::shaft_scene(bench::shaft_block(), rule, 0), {archive});
    rig.start(shaft_tip(0, 0, -0.5 * kShaftRadius));
    std::vector<double> forces = presses(rig, aside, kDepths[d]);
    const auto [least, most] = std::ranges::minmax(forces);
    row(name, fmt::format("R{}_least", d == 0 ? 4 : 2), least / reference[d], "reference");
    row(name, fmt::format("R{}_most", d == 0 ? 4 : 2), most / reference[d], "reference");
  }
  for (const double friction : {0.0, 0.3})
    for (const Way& way : {Way{"across", 1, 0}, Way{"along", 0, 1}}) {
      PressRig rig(bench::shaft_scene(bench::shaft_block(), rule, friction), {archive});
      rig.start(shaft_tip(0, 0, -0.5 * kShaftRadius));
      const SlideMeasures m = slide(rig, way, kShaftRadius / 2);
      const std::string slid = fmt::format("{}_{}_friction_{}", name, way.name, friction);
      row(slid, "mean", m.mean, "N");
      row(slid, "jump", m.jump, "1");
      row(slid, "ripple", m.ripple, "1");
      row(slid, "buzz", m.buzz, "1");
      row(slid, "turn", m.turn, "1");
    }
}

/// [N] by nodes on edges of an eighth of the radius, the mean over places of a triangle.
std::vector<double> reference(double per_edge) {
  const double h = kShaftRadius / per_edge, beside = 1.4 * kShaftRadius;
  const Archive archive = precompute(bench::shaft_block(beside), bench::shaft_block_of_edges(h, beside));
  PressRig rig(bench::shaft_scene(bench::shaft_block(beside), ContactRule::barycentric, 0), {archive});
  rig.start(shaft_tip(0, 0, -0.5 * kShaftRadius));
  std::vector<double> forces;
  for (const double depth : kDepths) {
    double sum = 0;
    const double aside[] = {0, 0.25 * h, 0.5 * h, 0.75 * h};
    const auto all = presses(rig, aside, depth);
    for (const double f : all) sum += f / all.size();
    row(fmt::format("reference_R_over_h_{}", per_edge), fmt::format("force_at_{:.2g}", depth), sum, "N");
    row(fmt::format("reference_R_over_h_{}", per_edge), fmt::format("spread_at_{:.2g}", depth), spread_of(all), "1");
    forces.push_back(sum);
  }
  return forces;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  using namespace palpate;
  const auto coarse = reference(2);
  auto fine = coarse;
  if (!bench::quick(argc, argv)) fine = reference(4);
  for (const double per_edge : {0.25, 0.5, 1.0, 2.0})
    for (const ContactRule rule : {ContactRule::barycentric, ContactRule::patch}) measure(per_edge, rule, fine);
}

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "common/contact/tool_contacts.hpp"
#include "tools/rig/slide.hpp"
#include "tools/study/measure.hpp"
#include "tools/study/solid_case.hpp"

/// The slide over a solid body: its path and its converged solution.
namespace palpate::study {
namespace {

constexpr Fineness kMesh{0.9, 1 / 4.0, 0.45, 8000}, kQuickMesh{1.1, 1 / 3.0, 0.6, 4500};
constexpr double kApart = 1 / 6.0;  // radii between two places of the converged solution

}  // namespace

const SurfacePath& SolidCase::slide_path() {
  if (slide_path_) return *slide_path_;
  const double radius = presses().radius;
  const PathPlan plan{.length = quick_ ? 2 * radius : std::max(4 * radius, 2 * palpate::mean_edge(surface_)),
                      .run_up = radius,
                      .step = kSlideSpeed / scene_.rates.haptic_hz,
                      .clear = radius};
  return slide_path_.emplace(surface_path(surface_, presses().patches.front(), plan));
}

const std::vector<double>& SolidCase::slide_reference(double depth) {
  const auto found = slide_reference_.find(depth);
  if (found != slide_reference_.end()) return found->second;
  const SurfacePath& path = slide_path();
  const auto stride = std::max<std::size_t>(1, static_cast<std::size_t>(kApart * presses().radius / path.step));
  std::vector<Patch> places;
  for (std::size_t i = path.run_up; i < path.places.size() + stride - 1; i += stride)
    places.push_back(path.places[std::min(i, path.places.size() - 1)]);
  const auto key_of_slide = fmt::format("slide to {} {}", depth, key(places, quick_ ? kQuickMesh : kMesh));
  const auto forces = cache_.get(key_of_slide, [&] { return solve_slide(places, depth); });
  std::vector<double>& at_all = slide_reference_[depth];
  at_all.assign(path.run_up, forces.front());
  for (std::size_t i = 0; i + path.run_up < path.places.size(); ++i) {
    const std::size_t before = i / stride, next = std::min(before + 1, forces.size() - 1);
    const double share = static_cast<double>(i % stride) / static_cast<double>(stride);
    at_all.push_back((1 - share) * forces[before] + share * forces[next]);
  }
  return at_all;
}

std::vector<double> SolidCase::solve_slide(std::span<const Patch> places, double depth) const {
  const auto begin = std::chrono::steady_clock::now();
  std::vector<Eigen::Vector3d> centres;
  for (const Patch& at : places) centres.push_back(at.point);
  int strides = 0;
  const LinearContact contact(refined(places, quick_ ? kQuickMesh : kMesh, strides), centres, reach(depth),
                              FiniteElement::p2);
  std::vector<double> forces;
  for (const Patch& at : places)
    forces.push_back(contact.press({centre_at(at, presses().radius, depth), presses().radius}).force.norm());
  say_(fmt::format(
      "  linear reference along the slide, {} places: {} nodes and those between, {} may touch the ball: {:.1f} s",
      places.size(), contact.problem().mesh.nodes.size(), contact.candidates(), seconds_since(begin)));
  return forces;
}

}  // namespace palpate::study

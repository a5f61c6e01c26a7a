#include "common/models/quasi_static/press_by_laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <stdexcept>

#include "common/fem/all_cores.hpp"
#include "common/fem/linear_contact.hpp"
#include "common/fem/newton_solid.hpp"
#include "common/mesh/surface.hpp"
#include "common/models/quasi_static/press_spots.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr Fineness kFineness{1, 0.3, 0.7, 3000};
constexpr int kSteps = 6;  // to the whole radius
constexpr NewtonSolid::Stepping kStepping{.stride = 0.2, .max_halvings = 3};
constexpr double kReach = 1.4;      // of the radius about the place, within which nodes may touch the ball
constexpr double kTouching = 1e-3;  // of the radius
constexpr int kClasses = 12;        // of nodes, by how far they go across the press

Sphere ball_at(const PressedSpot& spot, double depth) {
  return {spot.point + (depth - spot.radius) * spot.inward, spot.radius};
}

double depth_of(const PressedSpot& spot, std::size_t step) {
  return spot.radius * static_cast<double>(step) / kSteps;
}

/// The states of the body after each step that finds equilibrium, but not beyond `most` steps. `press(from, to)`:
/// brings the ball from one place to the next.
template <class Press>
std::vector<PressState> course(const PressedSpot& spot, std::size_t most, Press&& press) {
  std::vector<PressState> states;
  try {
    while (states.size() < most)
      states.push_back(
          press(ball_at(spot, depth_of(spot, states.size())), ball_at(spot, depth_of(spot, states.size() + 1))));
  } catch (const std::runtime_error&) {  // the range ends with the steps reached
  }
  return states;
}

/// A node beside the ball: displacement across the press [m], its true part along the linear one, and its weight.
struct Across {
  double linear, truth, weight;
};

class Comparison {
 public:
  Comparison(const TetMesh& mesh, const PressedSpot& spot) : mesh_(mesh), spot_(spot), surface_(extract_surface(mesh)) {
    area_ = node_areas(mesh.nodes, surface_.triangles);
  }

  void add(double depth, const PressState& linear, const PressState& truth) {
    const Sphere ball = ball_at(spot_, depth);
    const auto outside = [&](int n, const PressState& state) {
      return (mesh_.nodes[n] + state.displacement[n] - ball.centre).norm() > (1 + kTouching) * ball.radius;
    };
    for (const int n : surface_.nodes) {
      if (!outside(n, linear) || !outside(n, truth)) continue;  // held by the ball
      const Vector3d across = part_across(linear.displacement[n]);
      const double size = across.norm();
      if (size > 0)
        all_.push_back({size, across.dot(part_across(truth.displacement[n])) / size, area_[n] * size * size});
    }
  }

  /// One pair a class of nodes, all classes of the same weight: the factor that serves the class best.
  std::vector<PressedPlace::Pair> pairs() {
    std::ranges::sort(all_, {}, &Across::linear);
    double whole = 0;
    for (const Across& a : all_) whole += a.weight;
    std::vector<PressedPlace::Pair> pairs;
    auto at = all_.begin();
    double passed = 0;
    for (int c = 1; c <= kClasses; ++c) {
      double weight = 0, square = 0, product = 0;
      for (; at != all_.end() && (passed < whole * c / kClasses || c == kClasses); passed += at++->weight) {
        weight += at->weight;
        square += at->weight * at->linear * at->linear;
        product += at->weight * at->truth / at->linear;
      }
      if (weight <= 0) continue;
      const double mean = std::sqrt(square / weight);
      if (pairs.empty() || mean > pairs.back()[0]) pairs.push_back({mean, mean * product / weight});
    }
    return pairs;
  }

 private:
  Vector3d part_across(const Vector3d& u) const { return u - u.dot(spot_.inward) * spot_.inward; }

  const TetMesh& mesh_;
  const PressedSpot& spot_;
  Surface surface_;
  std::vector<double> area_;  // [m^2] per node
  std::vector<Across> all_;
};

PressedPlace press(const StaticProblem& problem, const PressedSpot& spot) {
  int strides = 0;
  const StaticProblem fine = refine_under_ball(problem, std::array{spot}, kFineness, strides);
  NewtonSolid solid(fine, Law::neo_hookean);
  const auto truth =
      course(spot, kSteps, [&](const Sphere& from, const Sphere& to) { return solid.press(from, to, kStepping); });
  const LinearContact contact(fine, std::array{spot.point}, kReach * spot.radius);
  const auto linear = course(spot, truth.size(), [&](const Sphere&, const Sphere& to) { return contact.press(to); });
  PressedPlace place{.at = spot.point};
  Comparison across(fine.mesh, spot);
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const PressedPlace::Pair force{linear[i].force.dot(spot.inward), truth[i].force.dot(spot.inward)};
    const PressedPlace::Pair before = place.force.empty() ? PressedPlace::Pair{0, 0} : place.force.back();
    if (!(force[0] > before[0]) || !(force[1] > before[1])) break;
    place.depth = depth_of(spot, i + 1);
    place.force.push_back(force);
    across.add(place.depth, linear[i], truth[i]);
  }
  place.radial = across.pairs();
  return place;
}

std::string sentence(std::size_t number, std::size_t of, const PressedPlace& place, double radius) {
  const std::string which = fmt::format("press {} of {}", number, of);
  if (place.force.empty()) return which + ": no equilibrium, left out";
  const std::string how_far = fmt::format("{}: to {:.3g} mm", which, 1e3 * place.depth);
  return place.depth > 0.99 * radius ? how_far : how_far + ", no equilibrium beyond";
}

}  // namespace

std::vector<PressedPlace> press_by_laws(const StaticProblem& problem, const SurfaceMap& surface,
                                        const NeoHookeanLaw& law, const std::string& body, const Progress& progress) {
  const auto spots = choose_spots(surface, law.ball_radius, law.places);
  std::vector<PressedPlace> places(spots.size());
  std::size_t done = 0;
  std::mutex telling;
  on_all_cores(spots.size(), [&] {
    return [&](std::size_t i) {
      const auto begin = std::chrono::steady_clock::now();
      places[i] = press(problem, spots[i]);
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
      const std::lock_guard lock(telling);
      if (progress) progress(sentence(++done, spots.size(), places[i], law.ball_radius), taken.count());
    };
  });
  std::erase_if(places, [](const PressedPlace& p) { return p.force.empty(); });
  if (places.empty())
    throw std::runtime_error(fmt::format("body '{}': [body.nonlinear]: no press with a ball of {} m finds equilibrium",
                                         body, law.ball_radius));
  return places;
}

}  // namespace palpate

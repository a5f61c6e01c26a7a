#include "tools/study/solid_case.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "common/fem/newton_solid.hpp"
#include "common/fem/refine_graded.hpp"
#include "common/mesh/surface.hpp"
#include "common/models/content_hash.hpp"
#include "common/models/solid/precompute.hpp"
#include "tools/study/ball_press.hpp"
#include "tools/study/kinds.hpp"
#include "tools/study/measure.hpp"

namespace palpate::study {
namespace {

// Of quadratic elements those of fine_linear().
constexpr Fineness kFineMesh{0.9, 1 / 4.0, 0.45, 8000}, neo_mesh{1, 1 / 5.0, 0.4, 4500};
constexpr Fineness kQuickFine{1.1, 1 / 3.0, 0.6, 4500}, quick_neo{1, 1 / 4.0, 0.6, 4500};
constexpr double kLevel = std::numbers::sqrt2;  // edges of a mesh against those of the next finer one

void append_answer(const PressAnswer& answer, std::vector<double>& numbers) {
  numbers.push_back(answer.force);
  for (const Eigen::Vector3d& u : answer.displacement) numbers.insert(numbers.end(), u.begin(), u.end());
}

Scene with_body(Scene scene, int index, Body body) {
  scene.bodies[index] = std::move(body);
  return scene;
}

}  // namespace

SolidCase::SolidCase(const Scene& scene, int body, OneMesh whole, bool quick, ReferenceCache cache, Say say)
    : second_mesh_(whole.joined ? content_hash(scene.bodies[body]) : ""),
      scene_(with_body(scene, body, std::move(whole.body))),
      solid_(std::move(whole.solid)),
      body_(body),
      quick_(quick),
      cache_(std::move(cache)),
      say_(std::move(say)),
      problem_(make_static_problem(solid(), std::move(whole.mesh))),
      surface_(make_surface_map(solid(), problem_.mesh, problem_.dofs)),
      errors_(node_areas(surface_.position, surface_.triangles), choose_presses(scene, surface_, quick)) {}

std::string SolidCase::name(const std::string& model) const {
  return scene_.bodies.size() == 1 ? model : fmt::format("{}:{}", solid().name, model);
}

Scene SolidCase::press_scene(const Scene& from, int patch) const {
  Body body = from.bodies[body_];
  std::visit([](auto& spec) { prepare_for_press(spec); }, body);
  return ball_scene(from, std::move(body), presses().patches[patch], presses().radius);
}

double SolidCase::reach(double depth) const {
  return 1.1 * std::sqrt((2 * presses().radius - depth) * depth);
}

StaticProblem SolidCase::refined(std::span<const Patch> places, Fineness fineness, int& strides) const {
  fineness.max_nodes += static_cast<int>(problem_.mesh.nodes.size());
  std::vector<PressedSpot> spots;
  for (const Patch& at : places) spots.push_back({at.point, at.inward, presses().radius});
  return refine_under_ball(problem_, spots, fineness, strides);
}

// Everything that a reference's numbers depend on: the body at rest without what the run time adds to it, the press,
// the mesh.
std::string SolidCase::key(std::span<const Patch> places, const Fineness& fineness) const {
  constexpr int definitions = 5;  // changes with every change of how references are solved
  const Body plain = as_kind<QuasiStaticSpec>(solid());
  std::string text = fmt::format("{} {}{} {} {} {}", definitions, content_hash(plain), second_mesh_, fineness.edge,
                                 fineness.ball, fineness.growth);
  for (const Patch& at : places)
    for (const double number : {at.point[0], at.point[1], at.point[2], at.inward[0], at.inward[1], at.inward[2]})
      text += fmt::format(" {}", number);
  text += fmt::format(" of {}", presses().radius);
  for (const double depth : presses().depths) text += fmt::format(" {}", depth);
  return text;
}

// Meshes of one place remain levels apart: all are graded as fast as the finest must be.
std::vector<double> SolidCase::solve_fine(int patch, double coarser) const {
  const Patch& at = presses().patches[patch];
  const auto begin = std::chrono::steady_clock::now();
  const Fineness& finest = quick_ ? kQuickFine : kFineMesh;
  int strides = 0;
  StaticProblem problem = refined(place(patch), finest, strides);
  if (coarser > 1) problem = refined(place(patch), finest.coarser(coarser), strides);
  const LinearContact contact(std::move(problem), std::array{at.point}, reach(presses().deepest()), FiniteElement::p2);
  std::vector<double> numbers;
  for (const double depth : presses().depths) {
    const PressState state = contact.press({centre_at(at, presses().radius, depth), presses().radius});
    append_answer({state.force.dot(at.inward), at_surface(state.displacement)}, numbers);
  }
  say_(fmt::format("  linear reference, place {}: {} nodes and those between, {} may touch the ball: {:.1f} s", patch,
                   contact.problem().mesh.nodes.size(), contact.candidates(), seconds_since(begin)));
  return numbers;
}

std::vector<PressAnswer> SolidCase::press_fine(int patch, double coarser) const {
  const auto key_of_mesh = fmt::format("linear {} {}", coarser, key(place(patch), quick_ ? kQuickFine : kFineMesh));
  const auto numbers = cache_.get(key_of_mesh, [&] { return solve_fine(patch, coarser); });
  const double* at = numbers.data();
  return read_answers(at, presses().depths.size());
}

std::vector<PressAnswer> SolidCase::read_answers(const double*& at, std::size_t count) const {
  std::vector<PressAnswer> answers(count);
  for (PressAnswer& answer : answers) {
    answer.force = *at++;
    for (int n = 0; n < surface_.size(); ++n, at += 3) answer.displacement.emplace_back(at[0], at[1], at[2]);
  }
  return answers;
}

const std::vector<PressAnswer>& SolidCase::fine(int patch) {
  const auto found = fine_.find(patch);
  if (found != fine_.end()) return found->second;
  return fine_[patch] = press_fine(patch, 1);
}

const PressAnswer& SolidCase::fine_linear(int patch, int depth) {
  return fine(patch)[depth];
}

std::array<double, 2> SolidCase::fine_linear_rest() {
  std::array<double, 2> square{0, 0};
  int count = 0;
  for (std::size_t p = 0; p < presses().patches.size(); ++p) {
    const auto& best = fine(static_cast<int>(p));
    const auto next = press_fine(static_cast<int>(p), kLevel);
    for (std::size_t d = 0; d < best.size(); ++d, ++count) {
      square[0] += std::pow(errors_.of_field(next[d].displacement, best[d].displacement), 2);
      square[1] += std::pow(next[d].force / best[d].force - 1, 2);
    }
  }
  return {std::sqrt(square[0] / count), std::sqrt(square[1] / count)};
}

// Newton's method is the dearest of all: it has the first patches alone.
const SolidCase::Nonlinearity& SolidCase::nonlinearity(int patch) {
  if (patch >= (quick_ ? 1 : 2)) {
    static const Nonlinearity none;
    return none;
  }
  const auto found = nonlinearity_.find(patch);
  if (found != nonlinearity_.end()) return found->second;
  const auto numbers = cache_.get("neo-Hookean " + key(place(patch), quick_ ? quick_neo : neo_mesh),
                                  [&] { return solve_nonlinear(patch); });
  Nonlinearity& both = nonlinearity_[patch];
  const double* at = numbers.data();
  both.nodes = static_cast<int>(*at++);
  both.iterations = static_cast<int>(*at++);
  both.penetration = *at++;
  for (auto* answers : {&both.neo_hookean, &both.linear}) {
    const double reached = *at++;
    const auto count = static_cast<std::size_t>(*at++);
    *answers = read_answers(at, count);
    if (count < presses().depths.size())
      both.gave_up =
          fmt::format("Newton's method does not converge under the ball at a depth beyond {:.3g} m", reached);
  }
  return both;
}

/// Nodes, Newton iterations of the large strains and the deepest node in the ball; then of both laws the last depth
/// reached, how many presses that are, and these.
std::vector<double> SolidCase::solve_nonlinear(int patch) const {
  const auto begin = std::chrono::steady_clock::now();
  const Patch& at = presses().patches[patch];
  int strides = 0;
  const StaticProblem problem = refined(place(patch), quick_ ? quick_neo : neo_mesh, strides);
  const auto ball = [&](double depth) { return Sphere{centre_at(at, presses().radius, depth), presses().radius}; };
  std::vector<double> numbers{static_cast<double>(problem.mesh.nodes.size()), 0, 0};
  for (const Law law : {Law::neo_hookean, Law::linear}) {
    NewtonSolid solid(problem, law);
    double before = 0, count = 0;
    std::vector<double> answers;
    try {
      for (const double depth : presses().depths) {
        const PressState state = solid.press(ball(before), ball(depth));
        append_answer({state.force.dot(at.inward), at_surface(state.displacement)}, answers);
        numbers[2] = std::max(numbers[2], state.penetration);
        before = depth;
        ++count;
      }
    } catch (const std::runtime_error&) {  // the depths reached stand
    }
    if (law == Law::neo_hookean) numbers[1] = solid.iterations();
    numbers.insert(numbers.end(), {before, count});
    numbers.insert(numbers.end(), answers.begin(), answers.end());
    say_(fmt::format("  {} reference, place {}: {} nodes, {} steps of load, {} Newton iterations: {:.1f} s",
                     law == Law::linear ? "linear law beside the neo-Hookean" : "neo-Hookean", patch,
                     problem.mesh.nodes.size(), solid.steps(), solid.iterations(), seconds_since(begin)));
  }
  return numbers;
}

// The coarser mesh of the neo-Hookean solution has an error of its own, which the linear one on the same mesh shares:
// what the law changes is added to the fine linear solution.
PressAnswers SolidCase::neo_hookean() {
  PressAnswers answers;
  for (int p = 0; p < static_cast<int>(presses().patches.size()); ++p) {
    const Nonlinearity& both = nonlinearity(p);
    std::vector<PressAnswer> of_patch;
    for (std::size_t d = 0; d < std::min(both.neo_hookean.size(), both.linear.size()); ++d) {
      PressAnswer answer = fine(p)[d];
      answer.force += both.neo_hookean[d].force - both.linear[d].force;
      for (std::size_t n = 0; n < answer.displacement.size(); ++n)
        answer.displacement[n] += both.neo_hookean[d].displacement[n] - both.linear[d].displacement[n];
      of_patch.push_back(std::move(answer));
    }
    answers.push_back(std::move(of_patch));
  }
  return answers;
}

void SolidCase::add_errors(const Row& cost, const PressAnswers& presses, Result& result) {
  PressAnswers linear;
  for (std::size_t p = 0; p < presses.size(); ++p) linear.push_back(fine(static_cast<int>(p)));
  errors_.add(cost, presses, linear, "fine_linear", result);
  errors_.add(cost, presses, neo_hookean(), "neo_hookean", result);
}

std::vector<Eigen::Vector3d> SolidCase::at_surface(const std::vector<Eigen::Vector3d>& of_nodes) const {
  std::vector<Eigen::Vector3d> u;
  for (const int n : surface_.node_number) u.push_back(of_nodes[n]);
  return u;
}

}  // namespace palpate::study

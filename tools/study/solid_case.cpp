#include "tools/study/solid_case.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/mesh/mesh_file.hpp"
#include "common/tensors/precompute.hpp"
#include "tools/study/reference/graded.hpp"
#include "tools/study/reference/newton.hpp"

namespace palpate::study {
namespace {

constexpr int most_nodes = 60000;  // of a reference's mesh

using Fineness = SolidCase::Fineness;
constexpr Fineness fine_mesh{0.6, 1 / 9.0, 0.28}, next_mesh{0.8, 1 / 6.0, 0.4}, neo_mesh{1, 1 / 5.0, 0.4};
constexpr Fineness quick_fine{0.8, 1 / 6.0, 0.35}, quick_next{1, 1 / 4.0, 0.5}, quick_neo{1, 1 / 4.0, 0.6};

}  // namespace

SolidCase::SolidCase(const Scene& scene, int body, bool quick)
    : scene_(scene),
      body_(body),
      quick_(quick),
      problem_(make_static_problem(this->body(), load_tet_mesh(this->body().mesh, this->body().scale))),
      surface_(make_surface_map(this->body(), problem_.mesh, problem_.dofs)),
      errors_(node_areas(surface_), choose_presses(scene, surface_, quick)) {}

std::string SolidCase::name(const std::string& model) const {
  return scene_.bodies.size() == 1 ? model : fmt::format("{}:{}", body().name, model);
}

Scene SolidCase::press_scene(const Scene& from, int patch) const {
  const Patch& at = presses().patches[patch];
  Scene scene;
  scene.file = from.file;
  scene.bodies = {from.bodies[body_]};
  scene.bodies[0].dynamic.gravity.setZero();
  scene.bodies[0].tearing.reset();
  scene.contact = from.contact;
  scene.contact.friction = 0;
  scene.rates = from.rates;
  scene.passivity.controller = false;
  Tool ball;
  ball.name = "ball";
  ball.axis = at.inward;
  ball.up = at.inward.unitOrthogonal();
  ball.radius = presses().radius;
  ball.shaft_radius = 0.3 * presses().radius;
  ball.shaft_length = 0.4 * presses().radius;
  ball.pivot = at.point - 0.3 * at.inward;
  ball.max_force = 1e9;
  ball.max_force_rate = 1e15;
  scene.tools = {ball};
  return scene;
}

double SolidCase::reach() const {
  const double d = presses().deepest(), r = presses().radius;
  return 1.1 * std::sqrt(2 * r * d - d * d);
}

StaticProblem SolidCase::refined(int patch, const Fineness& fineness) const {
  const double outer = fineness.edge * mean_edge(problem_.mesh);
  const double inner = std::min(outer, fineness.ball * presses().radius);
  return refine_graded(problem_,
                       size_around(presses().patches[patch].point, presses().patches[patch].inward,
                                   0.8 * presses().radius, inner, fineness.growth, outer),
                       most_nodes);
}

std::vector<PressAnswer> SolidCase::press_fine(int patch, const Fineness& fineness) const {
  const Patch& at = presses().patches[patch];
  const LinearContact contact(refined(patch, fineness), at.point, reach());
  std::vector<PressAnswer> answers;
  for (const double depth : presses().depths) {
    const PressState state = contact.press({centre_at(at, presses().radius, depth), presses().radius});
    answers.push_back({state.force.dot(at.inward), at_surface(state.displacement)});
  }
  return answers;
}

const std::vector<PressAnswer>& SolidCase::fine(int patch) {
  const auto found = fine_.find(patch);
  if (found != fine_.end()) return found->second;
  return fine_[patch] = quick_ ? press_fine(patch, quick_fine) : press_fine(patch, fine_mesh);
}

const PressAnswer& SolidCase::fine_linear(int patch, int depth) {
  return fine(patch)[depth];
}

std::array<double, 2> SolidCase::fine_linear_rest() {
  std::array<double, 2> square{0, 0};
  int count = 0;
  for (std::size_t p = 0; p < presses().patches.size(); ++p) {
    const auto& best = fine(static_cast<int>(p));
    const auto next = press_fine(static_cast<int>(p), quick_ ? quick_next : next_mesh);
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
  Nonlinearity& both = nonlinearity_[patch];
  const Patch& at = presses().patches[patch];
  const StaticProblem problem = refined(patch, quick_ ? quick_neo : neo_mesh);
  both.nodes = static_cast<int>(problem.mesh.nodes.size());
  const auto ball = [&](double depth) {
    return Sphere{centre_at(at, presses().radius, depth), presses().radius};
  };
  for (const Law law : {Law::neo_hookean, Law::linear}) {
    NewtonSolid solid(problem, law);
    std::vector<PressAnswer>& answers = law == Law::linear ? both.linear : both.neo_hookean;
    double before = 0;
    try {
      for (const double depth : presses().depths) {
        const PressState state = solid.press(ball(before), ball(depth));
        answers.push_back({state.force.dot(at.inward), at_surface(state.displacement)});
        both.penetration = std::max(both.penetration, state.penetration);
        before = depth;
      }
    } catch (const std::runtime_error& error) {
      both.gave_up = fmt::format("{} at a depth beyond {:.3g} m", error.what(), before);
    }
    if (law == Law::neo_hookean) both.iterations = solid.iterations();
  }
  return both;
}

// The coarser mesh of the neo-Hookean solution has an error of its own, which the linear one on the same mesh shares: what
// the law changes is added to the fine linear solution.
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

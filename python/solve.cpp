#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numeric>

#include "common/archive/static_solve.hpp"
#include "common/models/static_state.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/find_archive.hpp"
#include "python/bindings.hpp"

namespace palpate::python {
namespace {

using Hold = std::array<std::optional<double>, 3>;
using Force = std::array<double, 3>;

/// What a static state is asked for.
struct Asked {
  std::map<int, Hold> holds;
  std::map<int, Force> forces;
  Force gravity{};

  bool loaded() const { return !forces.empty() || gravity != Force{}; }
  std::vector<Constraint> constraints() const {
    std::vector<Constraint> held;
    for (const auto& [node, displacement] : holds)
      for (int axis = 0; axis < 3; ++axis)
        if (displacement[axis]) held.push_back(hold(node, axis, *displacement[axis]));
    return held;
  }
  std::vector<NodalLoad> loads() const {
    std::vector<NodalLoad> loads;
    for (const auto& [node, force] : forces) loads.push_back({node, Eigen::Vector3d(force.data())});
    return loads;
  }
};

/// A static state as lists with one entry a node.
struct State {
  std::vector<int> node;  ///< of the mesh
  std::vector<Eigen::Vector3d> position, displacement, force;
};

void require_finite(std::string_view what, double number) {
  if (!std::isfinite(number)) throw py::value_error(fmt::format("{}: {} is not a finite number", what, number));
}

void require_finite(const Asked& asked) {
  for (const auto& [node, displacement] : asked.holds)
    for (const auto& part : displacement) require_finite(fmt::format("the hold of node {}", node), part.value_or(0));
  for (const auto& [node, force] : asked.forces)
    for (const double part : force) require_finite(fmt::format("the force on node {}", node), part);
  for (const double part : asked.gravity) require_finite("gravity", part);
}

State by_tensors(const Scene& scene, const Body& body, const Asked& asked) {
  if (asked.gravity != Force{})
    throw py::value_error("an archive knows no loads inside: gravity needs method='direct'");
  ensure_archive(scene, body);
  const Archive archive = find_archive(scene, body, ArchivePart::surface);
  SurfaceSolution solution = solve_tensors(archive, asked.constraints(), asked.loads());
  return {archive.surface.node_number, archive.surface.position, solution.displacement, solution.force};
}

State by_direct(const Body& body, const Asked& asked) {
  const DirectProblem problem = std::visit([](const auto& spec) { return direct_problem(spec); }, body);
  const auto nodes = static_cast<int>(problem.mesh.nodes.size());
  std::vector<NodalLoad> loads = asked.loads();
  for (const NodalLoad& load : loads)
    if (load.node < 0 || load.node >= nodes) throw py::value_error(fmt::format("the mesh has no node {}", load.node));
  const StaticSolution solution =
      problem.solve(asked.constraints(), {loads, {}, Eigen::Vector3d(asked.gravity.data())});
  State state{std::vector<int>(nodes), problem.mesh.nodes, solution.displacement, solution.force};
  std::iota(state.node.begin(), state.node.end(), 0);
  return state;
}

/// [body.nonlinear], where the body has one. Returns how many times the linear forces the corrected ones are.
std::optional<double> correct(const Scene& scene, const Body& body, const Asked& asked, State& state) {
  const StaticCorrection correction = std::visit([](const auto& spec) { return static_correction(spec); }, body);
  if (!correction) return {};
  if (asked.loaded())
    throw py::value_error(
        fmt::format("body '{}' has [body.nonlinear], whose law is of tissue held at displacements: give holds alone",
                    name_of(body)));
  std::vector<int> places;
  for (std::size_t i = 0; i < state.node.size(); ++i)
    if (asked.holds.contains(state.node[i])) places.push_back(static_cast<int>(i));
  ensure_archive(scene, body);
  return correction(find_archive(scene, body, ArchivePart::header),
                    {places, state.position, state.displacement, state.force});
}

py::dict solve(const Scene& scene, const std::map<int, Hold>& holds, const std::string& body_name,
               const std::map<int, Force>& forces, const Force& gravity, const std::string& method) {
  const Body& body = body_of(scene, body_name);
  if (!std::visit([](const auto& spec) { return has_static_states(spec); }, body))
    throw py::value_error(fmt::format("body '{}' is a {}, which has no static state", name_of(body), kind_of(body)));
  if (method != "tensors" && method != "direct") throw py::value_error("method must be 'tensors' or 'direct'");
  const Asked asked{holds, forces, gravity};
  if (asked.constraints().empty() && !asked.loaded()) throw py::value_error("nothing is held or loaded");
  require_finite(asked);
  State state = method == "direct" ? by_direct(body, asked) : by_tensors(scene, body, asked);
  const std::optional<double> corrected = correct(scene, body, asked, state);
  require_numbers(state.node, state.displacement, state.force);
  py::dict result;
  result["node"] = py::array_t<int>(static_cast<py::ssize_t>(state.node.size()), state.node.data());
  result["position"] = rows_of(std::span(std::as_const(state.position)));
  result["displacement"] = rows_of(std::span(std::as_const(state.displacement)));
  result["force"] = rows_of(std::span(std::as_const(state.force)));
  if (corrected) result["correction"] = *corrected;
  return result;
}

}  // namespace

void bind_solve(py::module_& module) {
  module.def(
      "solve", &solve, py::arg("scene"), py::arg("holds") = std::map<int, Hold>(), py::arg("body") = "",
      py::arg("forces") = std::map<int, Force>(), py::arg("gravity") = Force{}, py::arg("method") = "tensors",
      "A static state of a body. `holds`: by mesh node, the displacement [m] along x, y and z, None leaves an axis "
      "free;\n"
      "`forces`: by mesh node, [N] on the tissue; `gravity` [m/s2]: the body's own weight. method 'tensors': of the "
      "surface,\n"
      "by the archive, computed first if it is not there, without gravity; 'direct': the full system afresh, at all "
      "nodes of the\n"
      "mesh, the reactions of fixed axes with it. Returns node (n,), position (n, 3) [m], displacement (n, 3) [m] "
      "and force\n"
      "(n, 3) [N] on the tissue; where the body has [body.nonlinear], which takes holds alone, the corrected ones, "
      "and\n"
      "correction: how many times the linear forces they are.");
}

}  // namespace palpate::python

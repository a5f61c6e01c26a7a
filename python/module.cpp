#include <fmt/format.h>

#include <map>

#include "common/archive/static_solve.hpp"
#include "common/models/static_state.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/find_archive.hpp"
#include "common/scene/scene_changes.hpp"
#include "python/bindings.hpp"

namespace palpate::python {
namespace {

using Changes = std::map<std::string, py::object>;

/// As --set takes them: TOML, or a word.
std::vector<SceneChange> changes_of(const Changes& set) {
  std::vector<SceneChange> changes;
  for (const auto& [key, value] : set) {
    std::string text = py::str(value);
    if (py::isinstance<py::bool_>(value)) text = value.cast<bool>() ? "true" : "false";
    changes.push_back(parse_change(key + "=" + text));
  }
  return changes;
}

std::vector<std::string> body_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Body& body : scene.bodies) names.push_back(name_of(body));
  return names;
}

std::vector<std::string> tool_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Tool& tool : scene.tools) names.push_back(tool.name);
  return names;
}

const Body& body_of(const Scene& scene, const std::string& name) {
  for (const Body& body : scene.bodies)
    if (name_of(body) == name || (name.empty() && scene.bodies.size() == 1)) return body;
  throw py::value_error(
      fmt::format("the scene has no body '{}': name one of {}", name, fmt::join(body_names(scene), ", ")));
}

using Hold = std::array<std::optional<double>, 3>;

/// [body.nonlinear], where the body has one. Returns how many times the linear forces the corrected ones are.
std::optional<double> correct(const Body& body, const Archive& archive, const std::map<int, Hold>& holds,
                              SurfaceSolution& solution) {
  const StaticCorrection correction = std::visit([](const auto& spec) { return static_correction(spec); }, body);
  if (!correction) return {};
  std::vector<int> places;
  for (std::size_t i = 0; i < archive.surface.node_number.size(); ++i)
    if (holds.contains(archive.surface.node_number[i])) places.push_back(static_cast<int>(i));
  return correction(archive, {places, archive.surface.position, solution.displacement, solution.force});
}

py::dict solve(const Scene& scene, const std::map<int, Hold>& holds, const std::string& body_name) {
  const Body& body = body_of(scene, body_name);
  if (!std::visit([](const auto& spec) { return has_static_states(spec); }, body))
    throw py::value_error(fmt::format("body '{}' is a {}, which has no static state", name_of(body), kind_of(body)));
  std::vector<Constraint> held;
  for (const auto& [node, displacement] : holds)
    for (int axis = 0; axis < 3; ++axis)
      if (displacement[axis]) held.push_back(hold(node, axis, *displacement[axis]));
  if (held.empty()) throw py::value_error("nothing is held");
  ensure_archive(scene, body);
  const Archive archive = find_archive(scene, body, ArchivePart::surface);
  SurfaceSolution solution = solve_tensors(archive, held);
  const std::optional<double> corrected = correct(body, archive, holds, solution);
  py::dict result;
  result["node"] = py::array_t<int>(static_cast<py::ssize_t>(archive.surface.node_number.size()),
                                    archive.surface.node_number.data());
  result["position"] = rows_of(std::span(archive.surface.position));
  result["displacement"] = rows_of(std::span(std::as_const(solution.displacement)));
  result["force"] = rows_of(std::span(std::as_const(solution.force)));
  if (corrected) result["correction"] = *corrected;
  return result;
}

}  // namespace
}  // namespace palpate::python

PYBIND11_MODULE(_core, module) {
  using namespace palpate;
  using namespace palpate::python;
  module.doc() = "palpate's simulator, in lock step, and its logs";
  module.attr("__version__") = PALPATE_VERSION;
  py::class_<Scene>(module, "Scene")
      .def(py::init([](const std::string& file, const Changes& set) { return load_scene(file, changes_of(set)); }),
           py::arg("file"), py::arg("set") = Changes(),
           "Reads and checks a scene file; `set` has keys in place of the file's, such as {\"body.young\": 8000}. "
           "Raises\n"
           "RuntimeError with the place and the sentence that the command line says.")
      .def_readonly("title", &Scene::title, "what a person reads")
      .def_property_readonly("bodies", &body_names, "names, in the order of the scene")
      .def_property_readonly("tools", &tool_names, "names, in the order of the scene")
      .def("to_toml", &to_toml, "the resolved scene, every default written out");
  module.def("solve", &solve, py::arg("scene"), py::arg("holds"), py::arg("body") = "",
             "A static state of a body's surface by its tensors, computed first if they are not there. `holds`: by "
             "mesh node, the\n"
             "displacement [m] along x, y and z, None leaves an axis free. Returns node (n,), position (n, 3) [m], "
             "displacement\n"
             "(n, 3) [m] and force (n, 3) [N] on the tissue; where the body has [body.nonlinear] the corrected ones, "
             "and correction: how\n"
             "many times the linear forces they are.");
  bind_simulator(module);
  bind_log(module);
}

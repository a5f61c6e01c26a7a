#include <fmt/format.h>

#include <map>

#include "common/describe/value_text.hpp"
#include "common/scene/scene_changes.hpp"
#include "python/bindings.hpp"
#include "tools/check.hpp"

namespace palpate::python {
namespace {

using Changes = std::map<std::string, py::object>;

/// A value of Python's or NumPy's as TOML writes it; what is no number, truth value or list is text.
std::string toml_of(const py::handle& value) {
  if (py::hasattr(value, "tolist")) return toml_of(value.attr("tolist")());  // NumPy's
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::int_>(value) || py::isinstance<py::float_>(value)) return py::str(value);
  if (!py::isinstance<py::list>(value) && !py::isinstance<py::tuple>(value))
    return value_text::text(std::string(py::str(value)));
  std::vector<std::string> entries;
  for (const py::handle& entry : value) entries.push_back(toml_of(entry));
  return value_text::list(entries);
}

std::vector<SceneChange> changes_of(const Changes& set) {
  std::vector<SceneChange> changes;
  for (const auto& [key, value] : set) changes.push_back(parse_change(key + "=" + toml_of(value)));
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

py::object checked(const Scene& scene) {
  CheckOutput out(true);
  check_scene(scene, out);
  return py::module_::import("json").attr("loads")(out.json().dump());
}

}  // namespace

const Body& body_of(const Scene& scene, const std::string& name) {
  for (const Body& body : scene.bodies)
    if (name_of(body) == name || (name.empty() && scene.bodies.size() == 1)) return body;
  throw py::value_error(
      fmt::format("the scene has no body '{}': name one of {}", name, fmt::join(body_names(scene), ", ")));
}

}  // namespace palpate::python

PYBIND11_MODULE(_core, module) {
  using namespace palpate;
  using namespace palpate::python;
  module.doc() = "palpate's simulator, in lock step, and its logs";
  py::class_<Scene>(module, "Scene", "A scene file, read and checked, with what is set in place of its keys.")
      .def(py::init(
               [](const std::filesystem::path& file, const Changes& set) { return load_scene(file, changes_of(set)); }),
           py::arg("file"), py::arg("set") = Changes(),
           "Reads and checks a scene file; `set` has keys in place of the file's, such as {\"body.young\": 8000}: "
           "numbers, truth\n"
           "values, texts, lists or arrays. Raises RuntimeError with the place and the sentence that the command line "
           "says.")
      .def_readonly("title", &Scene::title, "what a person reads")
      .def_property_readonly("bodies", &body_names, "names, in the order of the scene")
      .def_property_readonly("tools", &tool_names, "names, in the order of the scene")
      .def("to_toml", &to_toml, "the resolved scene, every default written out");
  module.def(
      "check", &checked, py::arg("scene"),
      "What `palpate check --json` says, as a dict: bodies and tools with what is said of each and the memory that "
      "they\n"
      "take, left_out, warnings, hash. Raises RuntimeError with the sentence where the scene cannot run.");
  bind_archive(module);
  bind_solve(module);
  bind_simulator(module);
  bind_log(module);
}

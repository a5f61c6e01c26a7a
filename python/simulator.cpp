#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/scene/ensure_archive.hpp"
#include "python/bindings.hpp"
#include "tools/drive/figures.hpp"
#include "tools/drive/lock_step.hpp"

namespace palpate::python {
namespace {

using Dofs = py::array_t<double, py::array::c_style | py::array::forcecast>;

constexpr int kBetweenSignals = 100;  // steps
constexpr int kDofs = 6;              // yaw, pitch, depth, roll, grip, pedal

std::vector<Archive> archives_of(const Scene& scene) {
  drive::lock_step_devices(scene);
  return load_or_precompute(scene, ArchivePart::surface);
}

template <class T, std::size_t N>
py::array_t<T> array_of(const std::array<T, N>& values) {
  return py::array_t<T>(N, values.data());
}

class Simulator {
 public:
  explicit Simulator(const Scene& scene)
      : scene_(scene),
        archives_(archives_of(scene)),
        lock_step_(scene, archives_),
        watch_(lock_step_.simulator(), archives_) {}

  double dt() const { return simulator().dt(); }
  double time() const { return lock_step_.time(); }
  bool over() const { return lock_step_.motions_over(); }

  void follow(int steps) {
    if (steps < 0) throw py::value_error(fmt::format("{} steps cannot be followed: give 0 or more", steps));
    for (int done = 0; done < steps; done += kBetweenSignals) {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();  // Ctrl-C
      const py::gil_scoped_release others_may_run;
      for (int i = done; i < std::min(steps, done + kBetweenSignals); ++i) {
        lock_step_.step();
        watch_.look(lock_step_.simulator());
      }
    }
  }

  void step(const Dofs& dofs) {
    if (dofs.ndim() != 2 || dofs.shape(0) != simulator().tools() || dofs.shape(1) != kDofs)
      throw py::value_error(
          fmt::format("dofs must be an array of shape ({}, {}): yaw, pitch, depth, roll, grip and "
                      "pedal of each tool",
                      simulator().tools(), kDofs));
    if (!std::all_of(dofs.data(), dofs.data() + dofs.size(), [](double d) { return std::isfinite(d); }))
      throw py::value_error("dofs must be finite");
    std::vector<sim::ToolInput> inputs;
    for (int t = 0; t < simulator().tools(); ++t) {
      const double* d = dofs.data(t);
      inputs.push_back({{d[0], d[1], d[2], d[3], d[4], d[5]}, simulator().steps() + 1});
    }
    const py::gil_scoped_release others_may_run;
    lock_step_.step(inputs);
    watch_.look(lock_step_.simulator());
  }

  py::array_t<double> dofs() const {
    auto array = new_array<double>(simulator().tools(), kDofs);
    double* to = array.mutable_data();
    for (const sim::ToolInput& input : lock_step_.inputs())
      for (const double x :
           {input.dofs.yaw, input.dofs.pitch, input.dofs.depth, input.dofs.roll, input.dofs.grip, input.dofs.pedal})
        *to++ = x;
    return array;
  }

  /// A vector of each tool.
  template <class Get>
  py::array_t<double> of_tools(Get&& get) const {
    std::vector<Eigen::Vector3d> vectors;
    for (int t = 0; t < simulator().tools(); ++t) vectors.push_back(get(simulator().tool(t)));
    return rows_of(std::span(std::as_const(vectors)));
  }
  py::array_t<double> force() const {
    return of_tools([](const sim::ToolView& tool) { return tool.force; });
  }
  py::array_t<double> torque() const {
    return of_tools([](const sim::ToolView& tool) { return tool.torque; });
  }
  py::array_t<double> tip() const {
    return of_tools([](const sim::ToolView& tool) -> Eigen::Vector3d { return tool.pose.translation(); });
  }
  std::vector<std::uint32_t> flags() const {
    std::vector<std::uint32_t> flags;
    for (int t = 0; t < simulator().tools(); ++t) flags.push_back(simulator().tool(t).flags);
    return flags;
  }

  py::array_t<double> surface(const std::string& body) {
    const sim::SurfaceView seen = shown(body);
    std::vector<Eigen::Vector3d> places;
    for (const Eigen::Vector3f& p : seen.position) places.push_back(seen.origin + p.cast<double>());
    return rows_of(std::span(std::as_const(places)));
  }
  sim::SurfaceView shown(const std::string& body) { return lock_step_.simulator().surface(number_of(body)); }
  const std::vector<std::array<int, 3>>& triangles(const std::string& body) const {
    return archives_[number_of(body)].surface.triangles;
  }

  py::list contacts(int tool) const {
    if (tool < 0 || tool >= simulator().tools()) throw py::index_error(fmt::format("there is no tool {}", tool));
    py::list list;
    for (const HeldContact& c : simulator().contacts(tool).contacts) {
      py::dict contact;
      contact["body"] = name_of(scene_.bodies[c.body]);
      contact["nodes"] = array_of(c.nodes);
      contact["weights"] = array_of(c.weights);
      contact["normal"] = array_of(c.normal);
      contact["force"] = array_of(c.force);
      contact["sticking"] = c.sticking != 0;
      list.append(contact);
    }
    return list;
  }

  std::map<std::string, double> figures() const {
    std::map<std::string, double> all;
    for (const drive::Figure& figure : watch_.figures(simulator())) all[figure.name] = figure.value;
    return all;
  }

 private:
  const sim::Simulator& simulator() const { return lock_step_.simulator(); }
  int number_of(const std::string& body) const {
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b)
      if (name_of(scene_.bodies[b]) == body || (body.empty() && scene_.bodies.size() == 1)) return static_cast<int>(b);
    throw py::value_error(fmt::format("the scene has no body '{}'", body));
  }

  Scene scene_;
  std::vector<Archive> archives_;
  drive::LockStep lock_step_;
  drive::Watch watch_;
};

}  // namespace

void bind_simulator(py::module_& module) {
  py::class_<Simulator>(
      module, "Simulator",
      "A scene in lock step: no clock, no bus, no picture. Its archives are computed first if they are not there. "
      "Tools are in\n"
      "the order of the scene; arrays are copies unless said otherwise, in metres and newtons, in the world frame "
      "unless said otherwise.")
      .def(py::init<const Scene&>(), py::arg("scene"))
      .def_property_readonly("dt", &Simulator::dt, "[s] of a step")
      .def_property_readonly("time", &Simulator::time, "[s] of the next step")
      .def_property_readonly("over", &Simulator::over, "whether every tool's scripted motion has ended")
      .def_property_readonly(
          "dofs", &Simulator::dofs,
          "(tools, 6): yaw, pitch [rad], depth [m], roll, grip [rad], pedal [0 or 1], of the last step")
      .def_property_readonly("force", &Simulator::force, "(tools, 3) [N] on each tool at its tip")
      .def_property_readonly("torque", &Simulator::torque, "(tools, 3) [N m] on each tool about its tip")
      .def_property_readonly("tip", &Simulator::tip, "(tools, 3) [m] where each tip is")
      .def_property_readonly("flags", &Simulator::flags, "bits of ForceFlag, per tool: docs/topics.md")
      .def("follow", &Simulator::follow, py::arg("steps") = 1, "so many steps with the scene's own motions")
      .def("step", &Simulator::step, py::arg("dofs"),
           "One step with these degrees of freedom, shaped like `dofs`. A jump that no hand can make is followed at a "
           "bounded\n"
           "speed.")
      .def("surface", &Simulator::surface, py::arg("body") = "", "(n, 3) [m] of each node of a body's surface map")
      .def(
          "origin",
          [](Simulator& s, const std::string& body) {
            const Eigen::Vector3d at = s.shown(body).origin;
            return array_of(std::array{at.x(), at.y(), at.z()});
          },
          py::arg("body") = "", "(3) [m] a point near the body, from which surface_view() counts")
      .def(
          "surface_view",
          [](const py::object& self, const std::string& body) {
            return view_of_rows(self.cast<Simulator&>().shown(body).position, self);
          },
          py::arg("body") = "",
          "(n, 3) float32 [m] of the same nodes from origin() on: a view, read-only, of the simulator's memory.\n"
          "A call of it, surface() or normals() brings it up to the last step; copy what is to stay")
      .def(
          "normals",
          [](const py::object& self, const std::string& body) {
            return view_of_rows(self.cast<Simulator&>().shown(body).normal, self);
          },
          py::arg("body") = "", "(n, 3) float32, unit, outward; a view like surface_view()")
      .def(
          "triangles",
          [](const py::object& self, const std::string& body) {
            return view_of_rows(self.cast<const Simulator&>().triangles(body), self);
          },
          py::arg("body") = "", "(m, 3) rows of surface(), outward, as they were before any cut; a view, read-only")
      .def("contacts", &Simulator::contacts, py::arg("tool") = 0,
           "What a tool holds of bodies that do not move by themselves: body, nodes (3), weights (3), normal (3), "
           "force (3) [N] on\n"
           "the tissue, sticking")
      .def("figures", &Simulator::figures, "what the run comes to so far, by the names of `palpate drive`");
}

}  // namespace palpate::python

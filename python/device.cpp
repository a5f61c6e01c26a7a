#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "common/bus/dds_bus.hpp"
#include "common/bus/force_follower.hpp"
#include "common/realtime/clock.hpp"

namespace py = pybind11;

namespace palpate::python {

/// The bus has threads, of which a forked process has none: it would wait for them for ever.
inline pid_t& process_of_the_bus() {
  static pid_t process = 0;  // none yet
  return process;
}
inline bool is_forked() {
  return process_of_the_bus() != 0 && process_of_the_bus() != getpid();
}
inline void refuse_forked() {
  if (is_forked())
    throw std::runtime_error(
        "palpate.Device: this process was forked from one with a device, whose threads it lacks: begin it with "
        "multiprocessing's 'spawn', or make devices only behind the fork");
}

/// A bus for this process.
inline std::unique_ptr<Bus> make_bus(const BusSettings& settings) {
  refuse_forked();
  process_of_the_bus() = getpid();
  return make_dds_bus(settings);
}

constexpr double kLongestWait = 1e9;             // [s]
constexpr std::int64_t kSignalNs = 100'000'000;  // between two looks for signals

/// A driver's ends of the bus, for one tool.
class Device {
 public:
  Device(std::uint32_t tool, int domain, const std::string& interface, const std::vector<std::string>& peers,
         const std::string& keys, const MotorLimits& limits)
      : bus_(make_bus({.domain = domain, .interface = interface, .peers = peers, .keys = keys, .role = "driver"})),
        writer_(bus_->writer(topics::device_state)),
        reader_(bus_->reader(topics::force_state, Keep::all)),
        follower_(tool, limits) {
    state_.tool = tool;
  }

  /// What a forked process has of it is let lie.
  ~Device() {
    if (!is_forked()) return;
    static_cast<void>(reader_.release());
    static_cast<void>(writer_.release());
    static_cast<void>(bus_.release());
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// False if it was not sent.
  bool write(const std::array<double, 6>& dofs, std::optional<std::int64_t> sense_ns) {
    state_.seq = written_ + 1;
    state_.sense_ns = sense_ns.value_or(now_ns());
    state_.yaw = dofs[0], state_.pitch = dofs[1], state_.depth = dofs[2];
    state_.roll = dofs[3], state_.grip = dofs[4], state_.pedal = dofs[5];
    const bool sent = writer_->write(state_);
    written_ += sent;
    return sent;
  }

  /// The newest force since the last call, as it was told.
  std::optional<ForceState> take() {
    hear();
    return std::exchange(newest_, std::nullopt);
  }
  /// What the motors are to give from now on.
  MotorForce motors() {
    hear();
    return fade();
  }
  /// The same for who lets go: what comes is not heard any more.
  MotorForce fade() { return follower_.give(now_ns()); }
  const ForceFollower& follower() const { return follower_; }

  /// Until something has come, or a signal that Python has a handler for.
  bool wait(double seconds) {
    if (std::isnan(seconds)) throw std::invalid_argument("seconds is no number");
    const std::int64_t end = now_ns() + static_cast<std::int64_t>(1e9 * std::clamp(seconds, 0.0, kLongestWait));
    for (std::int64_t left = end - now_ns();; left = end - now_ns()) {
      const bool has_come = [&] {
        const py::gil_scoped_release others;
        return bus_->wait(std::chrono::nanoseconds(std::clamp<std::int64_t>(left, 0, kSignalNs)));
      }();
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (has_come || left <= kSignalNs) return has_come;
    }
  }
  std::uint64_t written() const { return written_; }

 private:
  void hear() {
    while (const auto force = reader_->take())
      if (follower_.hear(*force, now_ns())) newest_ = force;
  }

  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Writer<DeviceState>> writer_;
  std::unique_ptr<Reader<ForceState>> reader_;
  ForceFollower follower_;
  std::optional<ForceState> newest_;
  DeviceState state_;
  std::uint64_t written_ = 0;
};

}  // namespace palpate::python

/// Python makes objects without their __init__ too, and forks.
template <>
class pybind11::detail::type_caster<palpate::python::Device> : public type_caster_base<palpate::python::Device> {
 public:
  bool load(handle source, bool convert) {
    if (isinstance<palpate::python::Device>(source) &&
        !reinterpret_cast<instance*>(source.ptr())->get_value_and_holder().holder_constructed())
      throw type_error("palpate.Device.__init__() was not called");
    palpate::python::refuse_forked();
    return type_caster_base<palpate::python::Device>::load(source, convert);
  }
};

PYBIND11_MODULE(_device, module) {
  using namespace palpate;
  using palpate::python::Device;
  module.attr("__version__") = PALPATE_VERSION;
  module.doc() = "drivers of devices: a tool's motion on the bus, and the force back";
  py::class_<ForceState>(module, "ForceState")
      .def_readonly("step", &ForceState::step, "haptic step number")
      .def_readonly("sense_ns", &ForceState::sense_ns, "sense time of that step, on the haptic node's clock")
      .def_readonly("force", &ForceState::force, "[N] on the tool at its tip, world")
      .def_readonly("torque", &ForceState::torque, "[N m] on the tool about its tip, world")
      .def_readonly("grip", &ForceState::grip, "[N m] on the handle, opening the jaws")
      .def_readonly("flags", &ForceState::flags, "bits of ForceFlag");
  py::class_<MotorForce>(module, "MotorForce")
      .def_readonly("force", &MotorForce::force, "[N] on the tool at its tip, world")
      .def_readonly("torque", &MotorForce::torque, "[N m] on the tool about its tip, world")
      .def_readonly("along", &MotorForce::along, "[N m, N m, N, N m] the same along yaw, pitch, depth, roll")
      .def_readonly("grip", &MotorForce::grip, "[N m] on the handle, opening the jaws");
  py::class_<Device>(
      module, "Device",
      "The driver of a tool: what a hand does goes out, the force on it comes back, as a motor may give it.")
      .def(py::init([](std::uint32_t tool, int domain, const std::string& interface,
                       const std::vector<std::string>& peers, const std::string& keys, double max_force,
                       double max_torque, double max_grip, double max_force_rate) {
             return std::make_unique<Device>(tool, domain, interface, peers, keys,
                                             MotorLimits{max_force, max_torque, max_grip, max_force_rate});
           }),
           py::arg("tool") = 0, py::kw_only(), py::arg("domain") = 0, py::arg("interface") = "",
           py::arg("peers") = std::vector<std::string>(), py::arg("keys") = "",
           py::arg("max_force") = MotorLimits{}.max_force, py::arg("max_torque") = MotorLimits{}.max_torque,
           py::arg("max_grip") = MotorLimits{}.max_grip, py::arg("max_force_rate") = MotorLimits{}.max_force_rate,
           "The driver of a tool whose device is \"bus\": `tool` is its place in the scene's list. `max_force` [N], "
           "`max_torque`,\n"
           "`max_grip` [N m], `max_force_rate` [N/s]: what its motors give, above 0. Raises RuntimeError with one "
           "sentence.")
      .def(
          "write", &Device::write, py::arg("dofs"), py::arg("sense_ns") = py::none(),
          "Yaw, pitch [rad], depth [m], roll, grip [rad], pedal. `sense_ns`: time.monotonic_ns() when the hardware was "
          "read, now if\n"
          "it is left out. False if it was not sent.")
      .def("motors", &Device::motors,
           "What the motors are to give from now on: call it once a tick. One haptic loop is followed; within the "
           "limits, and\n"
           "without a kick when it begins, falls silent or is another one.")
      .def("fade", &Device::fade, "The same without hearing what comes: for the end, until `limp`.")
      .def("take", &Device::take, "The newest force since the last call, as it was told, or None.")
      .def("wait", &Device::wait, py::arg("seconds"),
           "Sleeps until something may have come, at most so long [s], or a signal that Python handles. Raises "
           "ValueError "
           "for nan.")
      .def_property_readonly("written", &Device::written, "samples sent")
      .def_property_readonly(
          "limp", [](const Device& d) { return d.follower().limp(); }, "without force, since none comes")
      .def_property_readonly(
          "strange", [](const Device& d) { return d.follower().strange(); }, "forces of other haptic loops, not felt")
      .def_property_readonly(
          "refused", [](const Device& d) { return d.follower().refused(); },
          "forces that are no numbers, or ten times beyond the limits");
}

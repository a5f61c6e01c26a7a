// Thin walls: thickness, the singular triangle, coplanar patches, material.
#include <fmt/format.h>

#include <cmath>

#include "common/mesh/shell_generators.hpp"
#include "common/models/modal_shell/precompute.hpp"
#include "tools/rig/example_bodies.hpp"
#include "tools/stability/watch.hpp"

namespace palpate::stability {
namespace {

using Eigen::Vector3d;

Scene duct_scene(double thickness) {
  Scene scene = block_scene();
  scene.bodies[0] = duct_body(thickness);
  Tool& tool = scene.tools[0];
  tool.pivot = {0, 0.15, kDuctLength / 2};
  tool.axis = -Vector3d::UnitY();
  tool.up = Vector3d::UnitZ();
  std::get<ProbeSpec>(tool.end).radius = 0.003;
  tool.shaft_length = 0.02;
  return scene;
}

ModalShellSpec& duct_of(Scene& scene) {
  return std::get<ModalShellSpec>(scene.bodies[0]);
}

Result press_wall(const Scene& scene, const ShellMesh& mesh, double surface, double depth) {
  PressRig rig(scene, {precompute(std::get<ModalShellSpec>(scene.bodies[0]), mesh)});
  const auto at = [&](double above) { return Vector3d(0, surface + 0.003 + above, kDuctLength / 2); };
  rig.start(at(0.002));
  Watch watch;
  for (int i = 1; i <= 900; ++i) {
    const double share = i < 300 ? i / 300.0 : i < 600 ? 1.0 : (900 - i) / 300.0;
    rig.step(at(0.002 - share * (0.002 + depth)));
    watch.look(rig.haptic());
  }
  return watch.result();
}

/// Fifty taps on an undamped wall, each in and out of contact, the observer alone: what the hand gains comes from the
/// contact's coming and going between ticks.
Result tap_wall(double young, double rate, double speed) {
  Scene scene = duct_scene(0.001);
  duct_of(scene).material.young = young;
  duct_of(scene).shell.damping_ratio = 0;
  scene.contact.friction = 0;
  scene.rates.haptic_hz = rate;
  scene.passivity.controller = false;
  scene.tools[0].max_force = 1e6;
  scene.tools[0].max_force_rate = 1e12;
  PressRig rig(scene, {precompute(duct_of(scene), make_tube(kDuctRadius, kDuctLength, 12, 12))});
  constexpr double reach = 0.0003;  // [m] to both sides of the wall
  const auto at = [&](double time) {
    return Vector3d(0, kDuctRadius + 0.0035 + reach * std::cos(speed / reach * time), kDuctLength / 2);
  };
  rig.start(at(0));
  Watch watch;
  const int steps = static_cast<int>(50 * 2 * M_PI * reach / speed * rate);
  double most = 0, drop = 0;
  for (int i = 1; i <= steps; ++i) {
    rig.step(at(i / rate));
    watch.look(rig.haptic());
    const double energy = rig.simulator().energy();
    most = std::max(most, energy);
    drop = std::max(drop, most - energy);
  }
  Result r = watch.result();
  r.note = fmt::format("{:.3g} mJ put in by the taps at the end; given back in one go {:.3g} mJ at most{}{}",
                       1e3 * rig.simulator().energy(), 1e3 * drop, r.note.empty() ? "" : "; ", r.note);
  return r;
}

/// A plate in the plane y = 0: every triangle is coplanar with its neighbours.
ShellMesh plate_mesh(int cells) {
  ShellMesh mesh;
  const double h = kDuctLength / cells;
  for (int k = 0; k <= cells; ++k)
    for (int i = 0; i <= cells; ++i) mesh.nodes.push_back({h * i - kDuctLength / 2, 0, h * k});
  for (int k = 0; k < cells; ++k)
    for (int i = 0; i < cells; ++i) {
      const int a = k * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangles.push_back(
          {c, d, a});  // the right angle first: the corner order that the polynomial element cannot have
      mesh.triangles.push_back({b, a, d});
    }
  return mesh;
}

}  // namespace

std::vector<Point> shell_points(const Extent& extent) {
  std::vector<Point> points;
  for (double t : extent.quick ? std::vector{1e-5, 0.3} : std::vector{1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.2, 0.3})
    points.push_back({"shell thickness", "t/R [1]", fmt::format("{:g}", t),
                      [t] {
                        return press_wall(duct_scene(t * kDuctRadius), make_tube(kDuctRadius, kDuctLength, 12, 12),
                                          kDuctRadius * (1 + t / 2), 0.001);
                      },
                      120});
  for (const Bending bending : {Bending::polynomial, Bending::discrete_kirchhoff})
    points.push_back({"singular triangle", "bending", std::string(word_of(bending)), [=] {
                        Scene scene = duct_scene(0.001);
                        duct_of(scene).shell.bending = bending;
                        return press_wall(scene, plate_mesh(8), 0.0005, 0.001);
                      }});
  points.push_back({"coplanar patches", "plate of right triangles", "8 x 8",
                    [] { return press_wall(duct_scene(0.0005), plate_mesh(8), 0.00025, 0.001); }});
  for (double e : extent.quick ? std::vector{1.0, 1e12} : std::vector{1.0, 1e3, 1e6, 1e9, 1e12})
    points.push_back({"shell young", "E [Pa]", fmt::format("{:g}", e),
                      [e] {
                        Scene scene = duct_scene(0.001);
                        duct_of(scene).material.young = e;
                        return press_wall(scene, make_tube(kDuctRadius, kDuctLength, 12, 12), kDuctRadius + 0.0005,
                                          0.001);
                      },
                      120});
  for (double e : extent.quick ? std::vector{1e5} : std::vector{1e3, 1e4, 1e5, 1e6, 1e7, 1e8})
    points.push_back(
        {"taps on a duct", "E [Pa]", fmt::format("{:g}", e), [e] { return tap_wall(e, 1000, 0.05); }, 120});
  for (double v : extent.quick ? std::vector<double>{} : std::vector{0.005, 0.02, 0.1, 0.3})
    points.push_back({"taps on a duct", "speed at the wall [m/s]", fmt::format("{:g}", v),
                      [v] { return tap_wall(1e5, 1000, v); }, 120});
  for (double h : extent.quick ? std::vector<double>{} : std::vector{250.0, 500.0, 2000.0, 4000.0, 16000.0})
    points.push_back(
        {"taps on a duct", "rate [Hz]", fmt::format("{:g}", h), [h] { return tap_wall(1e5, h, 0.05); }, 120});
  for (double z : extent.quick ? std::vector{0.0} : std::vector{0.0, 0.01, 1.0, 100.0})
    points.push_back({"shell damping", "ratio [1]", fmt::format("{:g}", z),
                      [z] {
                        Scene scene = duct_scene(0.001);
                        duct_of(scene).shell.damping_ratio = z;
                        return press_wall(scene, make_tube(kDuctRadius, kDuctLength, 12, 12), kDuctRadius + 0.0005,
                                          0.001);
                      },
                      120});
  return points;
}

}  // namespace palpate::stability

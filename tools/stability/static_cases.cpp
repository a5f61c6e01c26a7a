// Materials, geometry, held nodes and presses of quasi-static bodies.
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "common/mesh/generators.hpp"
#include "common/mesh/quality.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "tools/rig/example_bodies.hpp"
#include "tools/stability/held_nodes.hpp"
#include "tools/stability/press.hpp"

namespace palpate::stability {
namespace {

using Eigen::Vector3d;

constexpr double kBallRadius = 0.008;

Result press_block(const std::function<void(Scene&)>& change, const TetMesh& mesh) {
  Scene scene = block_scene();
  change(scene);
  return press(scene, mesh, down_and_up(kBallRadius + 0.001, 0.004 - kBallRadius, 100), 300);
}

/// Moves the nodes of a block's inner layer so that the tetrahedra there become flat: angle [degrees] between their
/// faces.
TetMesh slivers(double degrees) {
  const double h = 0.1 / 6, thin = 0.5 * h * std::tan(degrees * M_PI / 180);
  const std::vector<double> across = graded_axis(-0.05, 0.05, 6, 1);
  return make_graded_block(across, across, {-0.05, -0.05 + h, -0.05 + h + thin, -h, 0});
}

TetMesh needles(double ratio) {
  const double h = 0.1 / 6, thin = h / ratio;
  std::vector<double> xs;
  for (int i = 0; i <= 6; ++i) xs.push_back(-0.05 + h * i);
  xs.insert(xs.begin() + 3, xs[2] + thin);
  return make_graded_block(xs, xs, {-0.05, -2 * h, -h, 0});
}

}  // namespace

std::vector<Point> material_points(const Extent& extent) {
  std::vector<Point> points;
  for (double e : extent.quick ? std::vector{1.0, 1e12} : std::vector{1.0, 1e2, 1e4, 1e6, 1e8, 1e10, 1e12})
    points.push_back({"young", "E [Pa]", fmt::format("{:g}", e),
                      [e] { return press_block([e](Scene& s) { block_of(s).material.young = e; }, block_mesh()); }});
  for (double c : extent.quick ? std::vector{1e8, 1e-8} : std::vector{1e2, 1e4, 1e6, 1e8, 1e-4, 1e-8})
    points.push_back({"contrast", "E upper / E lower [1]", fmt::format("{:g}", c), [c] {
                        return press_block(
                            [c](Scene& s) {
                              Material upper = block_of(s).material;
                              upper.young *= c;
                              block_of(s).materials.push_back(
                                  {{.indices = {}, .box = Box{{-1, -1, -0.026}, {1, 1, 1}}, .group = {}}, upper});
                            },
                            block_mesh());
                      }});
  for (double nu : extent.quick ? std::vector{0.4999999, 0.5}
                                : std::vector{-0.9, 0.0, 0.45, 0.49, 0.499, 0.4999, 0.49999, 0.499999, 0.4999999, 0.5})
    points.push_back({"poisson", "nu [1]", fmt::format("{:.7g}", nu), [nu] {
                        if (!(nu < 0.5)) {  // as a scene would say it, before the mesh is read
                          const std::string text = fmt::format(
                              "[[body]]\nname = \"a\"\nmesh = \"/proc/self/exe\"\nmodel = \"quasi_static\"\nyoung = "
                              "1000\npoisson = {}\n",
                              nu);
                          parse_scene(text, "a.toml");
                        }
                        return press_block([nu](Scene& s) { block_of(s).material.poisson = nu; }, block_mesh());
                      }});
  return points;
}

std::vector<Point> geometry_points(const Extent& extent) {
  std::vector<Point> points;
  for (double a : extent.quick ? std::vector{0.01} : std::vector{10.0, 1.0, 0.1, 0.01})
    points.push_back({"sliver", "least dihedral angle [deg]", fmt::format("{:g}", a), [a] {
                        Result r = press_block([](Scene&) {}, slivers(a));
                        r.note += fmt::format("{}layer {:.2g} mm thin", r.note.empty() ? "" : "; ",
                                              1e3 * 0.5 * 0.1 / 6 * std::tan(a * M_PI / 180));
                        return r;
                      }});
  for (double n : extent.quick ? std::vector{1e6} : std::vector{1e2, 1e4, 1e6})
    points.push_back({"needle", "length / width [1]; also size ratio", fmt::format("{:g}", n),
                      [n] { return press_block([](Scene&) {}, needles(n)); }});
  for (double s : extent.quick ? std::vector{1e-3, 1e6} : std::vector{1e-6, 1e-3, 1.0, 1e3, 1e6})
    points.push_back({"units", "size of the block / 0.1 m [1]", fmt::format("{:g}", s), [s] {
                        return press(block_scene(s), block_mesh(6, s),
                                     down_and_up(s * (kBallRadius + 0.001), s * (0.004 - kBallRadius), 100), 300);
                      }});
  return points;
}

std::vector<Point> hold_points(const Extent& extent) {
  std::vector<Point> points;
  const auto add = [&](const std::string& how, int count) {
    points.push_back({"held_nodes", how, std::to_string(count), [how, count] {
                        const TetMesh mesh = block_mesh(how == "spread" && count > 100 ? 16 : 8);
                        Scene scene = block_scene();
                        return hold_nodes(precompute(block_of(scene), mesh), how, count, 0.001, 512);
                      }});
  };
  for (int n : extent.quick ? std::vector{1, 64} : std::vector{1, 8, 64, 256, 512}) add("spread", n);
  for (const char* how : {"adjacent", "coincident", "contradictory", "collinear"})
    for (int n : extent.quick ? std::vector{8} : std::vector{2, 8, 64}) add(how, n);
  return points;
}

std::vector<Point> press_points(const Extent& extent) {
  std::vector<Point> points;
  for (double d : extent.quick ? std::vector{1e-12, 0.07} : std::vector{1e-12, 1e-9, 1e-6, 1e-3, 1e-2, 4e-2, 7e-2})
    points.push_back({"press", "depth [m] of 0.05", fmt::format("{:g}", d), [d] {
                        return press(block_scene(), block_mesh(),
                                     down_and_up(kBallRadius + 0.001, d - kBallRadius, 200), 600);
                      }});
  for (double v : extent.quick ? std::vector{0.0, 1e3} : std::vector{0.0, 1e-6, 0.1, 1.0, 10.0, 100.0, 1e3})
    points.push_back({"speed", "tool speed [m/s]", fmt::format("{:g}", v), [v] {
                        // To and fro over 0.2 m, through the block and out of its other side.
                        const auto path = [v](int i) {
                          const double way = v * 1e-3 * i, lap = std::fmod(way, 0.4);
                          return Vector3d(0.001, 0.002, 0.05 - (lap < 0.2 ? lap : 0.4 - lap));
                        };
                        return press(block_scene(), block_mesh(), path, 500);
                      }});
  for (const auto& [name, jump] :
       {std::pair{"once around the world", 4e7}, {"out of range", 1e300}, {"not a number", double(NAN)}})
    points.push_back(
        {"tool_pose", "tip jumps to", name, [jump = jump] {
           const auto path = [jump](int i) {
             return i < 50 ? Vector3d(0, 0, 0.02 - 4e-4 * i) : i < 60 ? Vector3d(0, 0, jump) : Vector3d(0, 0, 0.03);
           };
           return press(block_scene(), block_mesh(), path, 100);
         }});
  return points;
}

}  // namespace palpate::stability

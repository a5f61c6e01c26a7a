#include "tools/generate/liver_visual.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "common/mesh/shell_generators.hpp"
#include "tools/generate/liver.hpp"
#include "tools/generate/wrap.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kFrequency = 23;  // of the sphere that is wrapped around: 20 f^2 triangles

/// Around the patient's axis, from the back; upper edge at the head.
Eigen::Vector2f place_in_image(const Vector3d& p) {
  const double around = std::atan2(-p.x(), -p.y()) / (2 * std::numbers::pi) + 0.5;
  const double down = std::acos(std::clamp(p.z() / p.norm(), -1.0, 1.0)) / std::numbers::pi;
  return Eigen::Vector2d(around, down).cast<float>();
}

void add_liver(VisualMesh& mesh) {
  const TriangleMesh liver = wrap(liver_shape(), {0.13, 0.09, 0.06}, kFrequency);
  VisualMesh::Part part{.material = "liver", .textured = true};
  std::map<std::array<int, 2>, int> vertex;  // a node beyond the image's seam is another one there
  for (const auto& t : liver.triangles) {
    std::array<Eigen::Vector2f, 3> place;
    for (int k = 0; k < 3; ++k) place[k] = place_in_image(liver.nodes[t[k]]);
    const float most = std::max({place[0].x(), place[1].x(), place[2].x()});
    auto& corners = part.triangles.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const int beyond = most - place[k].x() > 0.5f;
      const auto [entry, is_new] = vertex.try_emplace({t[k], beyond}, static_cast<int>(mesh.position.size()));
      if (is_new) {
        mesh.position.push_back(liver.nodes[t[k]].cast<float>());
        mesh.image.emplace_back(place[k].x() + static_cast<float>(beyond), place[k].y());
      }
      corners[k] = entry->second;
    }
  }
  part.count = static_cast<int>(mesh.position.size());
  mesh.parts.push_back(std::move(part));
}

/// A smooth line through points, which it leaves and reaches as it runs there (Catmull and Rom 1974).
Vector3d on_line(const std::vector<Vector3d>& points, double s) {
  const int last = static_cast<int>(points.size()) - 1, i = std::min(static_cast<int>(s * last), last - 1);
  const double t = s * last - i;
  const Vector3d &b = points[i], &c = points[i + 1];
  const Vector3d a = i > 0 ? points[i - 1] : Vector3d(2 * b - c),
                 d = i + 1 < last ? points[i + 2] : Vector3d(2 * c - b);
  return 0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t * t * t);
}

/// A closed tube about a line, of a material of its own; `radius` [m] over the line's share, which ends in a point.
void add_tube(VisualMesh& mesh, const std::string& material, const std::array<double, 3>& colour, int around, int along,
              const std::vector<Vector3d>& line, const std::function<double(double)>& radius) {
  const auto closer = [](double s) { return s - 0.13 * std::sin(2 * std::numbers::pi * s); };  // rows at the ends
  const ShellMesh tube = make_tube([&](double s) { return on_line(line, closer(s)); },
                                   [&](double s) { return radius(closer(s)); }, around, along);
  if (mesh.parts.back().material != material)
    mesh.parts.push_back({.material = material, .colour = colour, .first = static_cast<int>(mesh.position.size())});
  VisualMesh::Part& part = mesh.parts.back();
  const int last = static_cast<int>(tube.nodes.size()) - around;  // the first node of the last ring
  const auto at_end = [&](int n) { return n < around ? 1 : n >= last ? 2 : 0; };
  const auto drawn = [&](int n) { return at_end(n) == 0 ? n : at_end(n) == 1 ? 0 : last; };  // a ring is a point there
  for (const auto& [a, b, c] : tube.triangles)
    if (drawn(a) != drawn(b) && drawn(b) != drawn(c) && drawn(c) != drawn(a))
      part.triangles.push_back({part.count + drawn(a), part.count + drawn(b), part.count + drawn(c)});
  for (int n = 0; n < last + around; ++n)
    mesh.position.push_back((at_end(n) == 0 ? tube.nodes[n] : on_line(line, at_end(n) == 1 ? 0 : 1)).cast<float>());
  mesh.image.resize(mesh.position.size(), Eigen::Vector2f::Zero());
  part.count += static_cast<int>(tube.nodes.size());
}

/// 1 between two ends, at each of which it falls to nothing as a circle does, over the share `end` of the way.
double rounded(double s, double end) {
  const double short_of = std::max(0.0, 1 - std::min(s, 1 - s) / end);
  return std::sqrt(std::max(1e-6, 1 - short_of * short_of));
}

/// A vessel or a duct.
std::function<double(double)> even(double radius) {
  return [radius](double s) { return radius * rounded(s, 0.06); };
}

/// Wide at the fundus, and narrow at the neck, where the duct goes on.
double pear(double s) {
  const double wide = 0.0175 - 0.0125 * s * s * (3 - 2 * s);
  return wide * (s < 0.5 ? rounded(s, 0.26) : rounded(s, 0.06));
}

}  // namespace

VisualMesh make_liver_visual() {
  VisualMesh mesh;
  add_liver(mesh);
  const std::array<double, 3> bladder{0.115, 0.155, 0.070}, bile{0.26, 0.27, 0.10}, vein{0.10, 0.075, 0.16},
      artery{0.42, 0.05, 0.04};
  const Vector3d neck(0.009, -0.021, -0.030), confluence(0.007, 0.003, -0.047);
  add_tube(mesh, "gall_bladder", bladder, 32, 26,
           {{0.003, -0.108, -0.029}, {0.004, -0.082, -0.034}, {0.006, -0.050, -0.036}, neck}, pear);
  add_tube(mesh, "bile_duct", bile, 12, 16, {neck, {0.012, -0.013, -0.031}, {0.009, -0.005, -0.038}, confluence},
           even(0.0022));
  add_tube(mesh, "bile_duct", bile, 14, 20,
           {{0.000, 0.008, -0.008}, {0.003, 0.007, -0.027}, confluence, {0.011, 0.006, -0.072}}, even(0.0034));
  add_tube(mesh, "portal_vein", vein, 20, 20,
           {{0.006, 0.013, -0.006}, {0.010, 0.015, -0.026}, {0.016, 0.017, -0.046}, {0.024, 0.019, -0.072}},
           even(0.0060));
  add_tube(mesh, "hepatic_artery", artery, 12, 20,
           {{0.016, 0.008, -0.007}, {0.018, 0.004, -0.026}, {0.024, 0.005, -0.046}, {0.034, 0.008, -0.070}},
           even(0.0024));
  join_places(mesh);
  return mesh;
}

}  // namespace palpate

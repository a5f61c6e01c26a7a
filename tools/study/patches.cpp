#include "tools/study/patches.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <stdexcept>

#include "common/contact/tool_contacts.hpp"
#include "common/tool/instrument.hpp"

namespace palpate::study {
namespace {

const Eigen::Vector3d weights(0.5, 0.3, 0.2);  // of the pressed point in its triangle

Eigen::Vector3d normal_of(const SurfaceMap& s, const std::array<int, 3>& t) {
  return (s.position[t[1]] - s.position[t[0]]).cross(s.position[t[2]] - s.position[t[0]]).normalized();
}

std::vector<Eigen::Vector3d> fixed_nodes(const SurfaceMap& s) {
  std::vector<Eigen::Vector3d> nodes;
  for (int n = 0; n < s.size(); ++n)
    if (s.fixed[n][0] || s.fixed[n][1] || s.fixed[n][2]) nodes.push_back(s.position[n]);
  return nodes;
}

double nearest(const std::vector<Eigen::Vector3d>& places, const Eigen::Vector3d& x) {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : places) least = std::min(least, (p - x).norm());
  return least;
}

/// Triangles around which the surface is smooth within the ball's reach: their cosines against it.
std::vector<double> smoothness(const SurfaceMap& s, double reach) {
  std::vector<double> smooth(s.triangles.size(), 1);
  std::vector<Eigen::Vector3d> middle, normal;
  for (const auto& t : s.triangles) {
    middle.push_back((s.position[t[0]] + s.position[t[1]] + s.position[t[2]]) / 3);
    normal.push_back(normal_of(s, t));
  }
  for (std::size_t i = 0; i < smooth.size(); ++i)
    for (std::size_t j = 0; j < smooth.size(); ++j) {
      const bool neighbours = std::ranges::find_first_of(s.triangles[i], s.triangles[j]) != s.triangles[i].end();
      if (neighbours || (middle[i] - middle[j]).norm() < reach)
        smooth[i] = std::min(smooth[i], normal[i].dot(normal[j]));
    }
  return smooth;
}

double study_radius(const Scene& scene, const SurfaceMap& surface, std::string& from) {
  for (const Tool& tool : scene.tools)
    if (const std::optional<double> ball = abilities_of(tool).ball) {
      from = "the tip of tool '" + tool.name + "'";
      return *ball;
    }
  from = "the mean edge of the surface, for want of a probe";
  return mean_edge(surface);
}

/// Of the mesh, of the corners of the patch's triangle.
int nearest_node(const SurfaceMap& surface, const Patch& patch) {
  const auto distance = [&](int n) { return (surface.position[n] - patch.point).norm(); };
  return surface.node_number[std::ranges::min(surface.triangles[patch.triangle], {}, distance)];
}

}  // namespace

Presses choose_presses(const Scene& scene, const SurfaceMap& surface, bool quick) {
  Presses presses;
  presses.radius = study_radius(scene, surface, presses.radius_from);
  for (const double share : quick ? std::vector{0.15, 0.3, 0.5} : std::vector{0.1, 0.2, 0.3, 0.4, 0.5})
    presses.depths.push_back(share * presses.radius);

  const auto fixed = fixed_nodes(surface);
  const auto smooth = smoothness(surface, 1.2 * presses.radius);
  // The smoothest part that leaves some choice, away from what is fixed if anything is.
  for (const double least : {0.8, 0.6, 0.4, -1.0})
    for (const double clear : {3.0, 1.5, 0.0}) {
      std::vector<Patch> free;
      for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
        const auto& nodes = surface.triangles[t];
        if (std::ranges::max(nodes) >= surface.touchable || smooth[t] < least) continue;
        Eigen::Vector3d at = Eigen::Vector3d::Zero();
        for (int v = 0; v < 3; ++v) at += weights[v] * surface.position[nodes[v]];
        if (nearest(fixed, at) >= clear * presses.radius) free.push_back({at, -normal_of(surface, nodes), t});
      }
      const std::size_t wanted = quick ? 2 : 3;
      if (free.size() < 3 * wanted && !(least < 0 && clear == 0)) continue;
      std::vector<Eigen::Vector3d> taken = fixed;
      while (presses.patches.size() < std::min(wanted, free.size())) {
        const auto next =
            std::ranges::max_element(free, {}, [&](const Patch& p) { return std::min(1e3, nearest(taken, p.point)); });
        presses.patches.push_back(*next);
        presses.nodes.push_back(nearest_node(surface, *next));
        if (presses.patches.size() == 1) taken.clear();
        taken.push_back(next->point);
      }
      if (presses.patches.empty()) throw std::runtime_error("no triangle of the surface can be touched");
      return presses;
    }
  return presses;
}

}  // namespace palpate::study

#include "tools/organ/scene_places.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "common/scene/scene.hpp"
#include "common/tool/instrument.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {
namespace {

constexpr double kNearOf = 3, kEdgeOf = 0.5;  // of the tip's radius: what it comes near, and edges there
constexpr int kTimes = 400;                   // at which a motion is looked at

/// Places in the box, no nearer to one another than the radius of the tool's end.
void add_places_of(const Tool& tool, const Trajectory& way, const Eigen::AlignedBox3d& box,
                   std::vector<FinePlace>& places) {
  const Trocar trocar = make_trocar(tool.pivot, tool.axis, tool.up);
  for (int i = 0; i <= kTimes; ++i) {
    const ToolDofs dofs = way.at(way.duration() * i / kTimes);
    const ToolPart end = tool_parts(tool, dofs.grip).front();
    const Eigen::Vector3d place = (tip_pose(trocar, dofs) * end.pose).translation();
    const auto is_near = [&](const FinePlace& p) { return (p.low - place).norm() < end.radius; };
    if (box.exteriorDistance(place) < end.radius && std::ranges::none_of(places, is_near))
      places.push_back(pressed_place(place, end.radius));
  }
}

}  // namespace

FinePlace pressed_place(const Eigen::Vector3d& place, double radius) {
  return {place, place, kNearOf * radius, kEdgeOf * radius};
}

std::vector<FinePlace> pressed_places(const std::filesystem::path& scene, const std::vector<Eigen::Vector3d>& surface) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : surface) box.extend(p);
  std::vector<FinePlace> places;
  for (const Tool& tool : load_scene(scene).tools)
    if (const std::optional<Trajectory> way = script_of(tool.device)) add_places_of(tool, *way, box, places);
  return places;
}

}  // namespace palpate

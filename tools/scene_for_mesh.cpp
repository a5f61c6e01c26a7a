#include "tools/scene_for_mesh.hpp"

#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/mesh/group_names.hpp"
#include "common/mesh/normals.hpp"
#include "common/mesh/surface.hpp"
#include "common/tool/devices/device_spec.hpp"

namespace palpate {
namespace {

constexpr double kStandOff = 0.02;                  // [m] between tip and tissue at the start
constexpr double kFieldOfView = 50;                 // [degrees]
constexpr double kShortest = 0.12, kLongest = 1.5;  // [m] from the pivot to the tissue; no tool is longer than 2 m

struct Spot {
  Eigen::Vector3d place, normal;
};

Eigen::Vector3d mean_place(const TetMesh& mesh, const std::vector<int>& nodes) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int n : nodes) sum += mesh.nodes[n];
  return sum / static_cast<double>(nodes.size());
}

/// The surface's node farthest along the way from where the body is held through its middle: nothing of the body lies
/// beyond it, so that the way to it is free.
Spot farthest_spot(const TetMesh& mesh, const Surface& surface, const std::vector<int>& held) {
  Eigen::Vector3d away = mean_place(mesh, surface.nodes) - mean_place(mesh, held);
  if (away.norm() == 0) away = Eigen::Vector3d::UnitZ();
  away.normalize();
  std::vector<Eigen::Vector3d> normals(mesh.nodes.size());
  vertex_normals(mesh.nodes, surface.triangles, normals);
  const int spot = *std::ranges::max_element(surface.nodes, {}, [&](int n) { return away.dot(mesh.nodes[n]); });
  if (std::ranges::binary_search(held, spot))
    throw std::runtime_error("the group by which the body is held is all around it");
  const Eigen::Vector3d normal = normals[spot].dot(away) > 0.5 ? normals[spot] : away;
  return {mesh.nodes[spot], normal};
}

double extent_of(const TetMesh& mesh, const Surface& surface) {
  Eigen::Vector3d low = mesh.nodes[surface.nodes[0]], high = low;
  for (const int n : surface.nodes) low = low.cwiseMin(mesh.nodes[n]), high = high.cwiseMax(mesh.nodes[n]);
  return (high - low).norm();
}

std::string vector_text(const Eigen::Vector3d& x) {
  return fmt::format("[{:.5f}, {:.5f}, {:.5f}]", x.x(), x.y(), x.z());
}

/// z, unless the line of sight is along it.
Eigen::Vector3d up_across(const Eigen::Vector3d& sight) {
  return std::abs(sight.normalized().z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
}

/// Of the groups that have the name of another tissue than the body's own.
std::string material_text(const TetMesh& mesh, const Tissue& own) {
  std::string text;
  for (const auto& [name, group] : mesh.groups) {
    const Tissue* const tissue = find_tissue(name);
    if (!tissue || tissue == &own || group.tetrahedra.empty()) continue;
    text += fmt::format(
        "\n[[body.material]]\ngroup = \"{}\"\nyoung = {}   # Pa; {} to {}: {}\npoisson = {}\ndensity = {}\n", name,
        tissue->young, tissue->young_low, tissue->young_high, tissue->source, tissue->poisson, tissue->density);
  }
  return text;
}

std::string visual_text(const VisualSpec& visual) {
  if (visual.surface.empty()) return "";
  std::string text = fmt::format("\n[body.visual]\nsurface = \"{}\"\n", visual.surface.string());
  if (!visual.materials.empty()) text += fmt::format("materials = \"{}\"\n", visual.materials.string());
  if (!visual.texture.empty()) text += fmt::format("texture = \"{}\"\n", visual.texture.string());
  return text + fmt::format("scale = {}   # m\n", visual.scale);
}

std::string camera_text(const Spot& spot, const Eigen::Vector3d& middle, double extent) {
  const Eigen::Vector3d side = spot.normal.cross(up_across(spot.normal)).normalized();
  const Eigen::Vector3d from = (side + 0.6 * spot.normal + 0.3 * up_across(spot.normal)).normalized();
  const double distance = 0.42 * extent / std::sin(kFieldOfView * 3.14159265 / 360);
  const Eigen::Vector3d target = 0.7 * middle + 0.3 * spot.place;
  return fmt::format(
      "\n[render]\nwidth = 1024\nheight = 768\n\n[render.camera]\neye = {}\ntarget = {}\nup = {}\nfield_of_view = {}\n",
      vector_text(target + distance * from), vector_text(target), vector_text(up_across(from)), kFieldOfView);
}

/// `depth`: [m] at which the tip touches.
std::string trajectory_text(double depth, double press) {
  const double slide = 0.3 * press / depth;
  std::string text =
      "# The probe comes near, presses, slides a little and goes back.\ntime,yaw,pitch,depth,roll,grip\n";
  const auto row = [&](double time, double yaw, double at) {
    text += fmt::format("{},{:.6f},0,{:.6f},0,0\n", time, yaw, at);
  };
  row(0, 0, depth - kStandOff);
  row(1, 0, depth - 0.002);
  row(3, 0, depth + press);
  row(4, 0, depth + press);
  row(5, slide, depth + press);
  row(6, slide, depth + press);
  row(7, 0, depth - 0.002);
  row(8, 0, depth - kStandOff);
  return text;
}

}  // namespace

SceneTexts scene_for(const TetMesh& mesh, const std::string& mesh_name, const std::string& trajectory_name,
                     const Tissue& tissue, const SceneWishes& wishes) {
  const auto held = mesh.groups.find(wishes.fixed);
  if (held == mesh.groups.end())
    throw std::runtime_error(
        fmt::format("it has no group '{}' to hold the body by{}", wishes.fixed,
                    mesh.groups.empty() ? "" : fmt::format(", but {}", fmt::join(group_names(mesh.groups), ", "))));
  const Surface surface = extract_surface(mesh);
  const Spot spot = farthest_spot(mesh, surface, held->second.nodes);
  const double extent = extent_of(mesh, surface);
  const double press = wishes.press > 0 ? wishes.press : std::min(extent / 40, 0.5 * wishes.radius);
  if (press > extent)
    throw std::runtime_error(fmt::format("--press: {:.3g} mm are more than the body's size, {:.3g} mm: it is in metres",
                                         1e3 * press, 1e3 * extent));
  const double reach = std::clamp(0.5 * extent, kShortest, kLongest);
  const Eigen::Vector3d pivot = spot.place + reach * spot.normal;
  SceneTexts texts;  // body and device are of the tables' first kinds: solved beforehand, moved by a file
  texts.trajectory = trajectory_text(reach - wishes.radius, press);
  texts.scene = fmt::format(R"(title = "A probe presses {0}"

[[body]]
name = "{0}"
mesh = "{1}"
young = {2}   # Pa; {3} to {4}: {5}
poisson = {6}
density = {7}   # kg/m3
{8}
[[body.fixed]]
group = "{9}"
{16}
[[tool]]
name = "instrument"
pivot = {10}
axis = {11}
up = {12}
radius = {13}
device = "{15}"
trajectory = "{14}"

[contact]
friction = 0.3
)",
                            tissue.name, mesh_name, tissue.young, tissue.young_low, tissue.young_high, tissue.source,
                            tissue.poisson, tissue.density, material_text(mesh, tissue), wishes.fixed,
                            vector_text(pivot), vector_text(-spot.normal), vector_text(up_across(spot.normal)),
                            wishes.radius, trajectory_name, kind_of(DeviceSpec{}), visual_text(wishes.visual));
  texts.scene += camera_text(spot, mean_place(mesh, surface.nodes), extent);
  return texts;
}

}  // namespace palpate

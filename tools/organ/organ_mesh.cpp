#include "tools/organ/organ_mesh.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "common/mesh/measures.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/surface.hpp"
#include "tools/organ/angles_around.hpp"
#include "tools/organ/better_angles.hpp"
#include "tools/organ/finding.hpp"
#include "tools/organ/mesh_pieces.hpp"
#include "tools/organ/part_volumes.hpp"

namespace palpate {
namespace {

constexpr double kNodesOfArea = 1.5;  // times the edge squared over the area of the surface
constexpr int kTries = 4;             // for a number of nodes
constexpr double kNearEnough = 0.08;  // of the number of nodes
constexpr double kWorstAngle = 12;    // [degrees] that every mesh has
constexpr double kKeptAngle =
    14;  // [degrees] to which moving a node to the surface may lower one, and worse ones are bettered
constexpr int kBetterings = 3;         // after the surface is exact
constexpr int kOtherEdges = 5;         // tried where a mesh is no good
constexpr double kLongestOfWall = 4;   // times its thickness: no edge finds both sides of a wall that is longer
constexpr double kLongestOfGuess = 2;  // where the deviation asks for more nodes, longer edges do not help
constexpr double kOfWall = 0.25;       // by how much of its thickness a wall's surfaces may be missed
constexpr double kMaxNodes = 3e6;      // of a mesh
constexpr double kFoundWithin = 1e-4;  // of the box's diagonal: the mesher finds a surface no more exactly
constexpr double kMissing = 0.3;       // of a part's volume: more than chords take

MeshSizes sizes_at(const Solid& solid, const MeshFineness& f, double edge) {
  const double inside = f.inside > 0 ? f.inside : 2.5 * edge;
  const double deviation = f.deviation > 0 ? f.deviation : edge / 12;
  return {edge, std::max(inside, edge), std::min(deviation, kOfWall * solid.wall.thickness), f.fine};
}

double nodes_at(const Solid& solid, const MeshSizes& sizes) {
  return static_cast<double>(fill_solid(solid, sizes, false).mesh.nodes.size());
}

double first_guess(const SolidMeasures& measures, const MeshFineness& f) {
  return std::sqrt(kNodesOfArea * measures.area / f.nodes);
}

/// The edge that gives about so many nodes, found on meshes that are not bettered.
double edge_for(const Solid& solid, const SolidMeasures& measures, const MeshFineness& f,
                const std::function<void(const std::string&)>& say) {
  const double longest = kLongestOfGuess * first_guess(measures, f);
  double edge = first_guess(measures, f), nodes = 0;
  for (int i = 0; i < kTries; ++i) {
    nodes = nodes_at(solid, sizes_at(solid, f, edge));
    const double off = nodes / f.nodes;
    if (std::abs(off - 1) < kNearEnough) return edge;
    if (off > 1 && edge == longest) break;
    edge = std::min(edge * std::pow(off, 0.45), longest);
  }
  say(fmt::format(
      "of the {} nodes that are asked for, about {:.0f} are as near as the shape, --deviation and fine places allow",
      f.nodes, nodes));
  return edge;
}

/// Puts the surface's nodes where the surface is exactly, as far as the tetrahedra around them stay good.
void project(const Solid& solid, TetMesh& mesh) {
  if (!solid.nearest) return;
  const AnglesAround angles(mesh);
  for (const int n : extract_surface(mesh).nodes) {
    const Eigen::Vector3d before = mesh.nodes[n];
    const double angle = angles.least(n);
    mesh.nodes[n] = solid.nearest(before);
    if (const double now = angles.least(n); now < kKeptAngle && now < angle) mesh.nodes[n] = before;
  }
}

/// Walls and necks that the edges are too long for are lost; nothing that comes later would tell.
void check_complete(const Solid& solid, const SolidMeasures& measures, const FilledSolid& filled) {
  const std::vector<double> volumes = volumes_of(filled, filled.part.empty() ? 0 : std::ranges::max(filled.part));
  for (std::size_t p = 0; p < std::min(volumes.size(), measures.volumes.size()); ++p)
    if (volumes[p] < (1 - kMissing) * measures.volumes[p])
      throw std::runtime_error(
          fmt::format("{:.0f} % of its volume were lost", 100 * (1 - volumes[p] / measures.volumes[p])));
  const std::vector<MeshPiece> pieces = pieces_of(filled.mesh);
  if (pieces.size() > 1)
    throw std::runtime_error(
        fmt::format("the mesh falls into {} pieces, one of {:.3g} ml at {} and one of {:.3g} ml at {}", pieces.size(),
                    1e6 * pieces[0].volume, place_in_mm(solid.in_world(pieces[0].place)), 1e6 * pieces[1].volume,
                    place_in_mm(solid.in_world(pieces[1].place))));
}

std::string advice(const Solid& solid, const SolidMeasures& measures, double edge) {
  const ThinWall& wall = solid.wall;
  if (edge <= wall.thickness) return "ask for more nodes or a shorter edge";
  return fmt::format("its walls are {:.3g} mm thick at {}: ask for --edge {:.2g}, which is about {:.2g} nodes",
                     1e3 * wall.thickness, place_in_mm(solid.in_world(wall.place)), wall.thickness,
                     kNodesOfArea * measures.area / (wall.thickness * wall.thickness));
}

/// About how many nodes edges ask for: on the surface, inside, and in fine places.
double nodes_asked(const Solid& solid, const SolidMeasures& measures, const MeshSizes& sizes) {
  const Eigen::AlignedBox3d whole(solid.low, solid.high);
  const std::vector<double>& parts = measures.volumes;
  const double volume = parts.empty() ? whole.volume() : std::reduce(parts.begin(), parts.end());
  double nodes = kNodesOfArea * measures.area / std::pow(sizes.edge, 2) + volume / std::pow(sizes.inside, 3);
  for (const FinePlace& f : sizes.fine) {
    const Eigen::Vector3d around = Eigen::Vector3d::Constant(f.radius + f.edge);
    const Eigen::AlignedBox3d place = whole.intersection({f.low - around, f.high + around});
    if (!place.isEmpty()) nodes += place.volume() / std::pow(f.edge, 3);
  }
  return nodes;
}

void check_affordable(const Solid& solid, const SolidMeasures& measures, const MeshSizes& sizes) {
  const double nodes = nodes_asked(solid, measures, sizes);
  if (nodes <= kMaxNodes) return;
  double shortest = sizes.edge;
  for (const FinePlace& f : sizes.fine) shortest = std::min(shortest, f.edge);
  throw std::runtime_error(
      fmt::format("edges of {:.3g} mm would be about {:.2g} nodes, and a mesh has {:.2g} at most: ask for longer ones",
                  1e3 * shortest, nodes, kMaxNodes));
}

/// A triangle cannot come nearer to the surface than the mesher finds it: it would be halved without end.
void check_deviation(const Solid& solid, double deviation) {
  const double least = kFoundWithin * (solid.high - solid.low).norm();
  if (deviation > 0 && deviation < least)
    throw std::runtime_error(fmt::format(
        "a deviation of {:.3g} mm is less than the surface is found within, {:.3g} mm: ask for a larger one",
        1e3 * deviation, 1e3 * least));
}

FilledSolid fill_checked(const Solid& solid, const SolidMeasures& measures, const MeshSizes& sizes) {
  FilledSolid filled = fill_solid(solid, sizes);
  give_stray_pieces_away(filled);
  check_complete(solid, measures, filled);
  project(solid, filled.mesh);
  for (int i = 0; i < kBetterings; ++i) {
    better_angles(kKeptAngle, filled);
    if (!measures.volumes.empty()) match_volumes(measures.volumes, solid.room, filled);
  }
  check_tet_mesh(filled.mesh, "the mesh that was made");
  if (const double angle = measures_of(filled.mesh).min_angle; angle < kWorstAngle)
    throw std::runtime_error(
        fmt::format("its smallest dihedral angle is {:.1f} degrees, less than {}", angle, kWorstAngle));
  return filled;
}

}  // namespace

FilledSolid make_organ_mesh(const Solid& solid, const SolidMeasures& measures, const MeshFineness& fineness,
                            const std::function<void(const std::string&)>& say) {
  double edge = fineness.edge > 0 ? fineness.edge : first_guess(measures, fineness);
  if (edge > kLongestOfWall * solid.wall.thickness)
    throw std::runtime_error(
        fmt::format("edges of {:.3g} mm are too long: {}", 1e3 * edge, advice(solid, measures, edge)));
  check_affordable(solid, measures, sizes_at(solid, fineness, edge));
  check_deviation(solid, fineness.deviation);
  if (fineness.edge == 0) {
    say(fmt::format("looking for the edge length that gives {} nodes", fineness.nodes));
    edge = edge_for(solid, measures, fineness, say);
  }
  std::string fault;
  for (int i = 0; i < kOtherEdges; ++i, edge *= 0.97) try {
      say(fmt::format("filling it with tetrahedra, at most {:.3g} mm along the surface", 1e3 * edge));
      return fill_checked(solid, measures, sizes_at(solid, fineness, edge));
    } catch (const std::runtime_error& error) {
      const bool again = fault == error.what();  // shorter edges do not help
      fault = error.what();
      say(fault);
      if (again) break;
    }
  throw std::runtime_error(fmt::format("no good mesh was found: {}; {}", fault, advice(solid, measures, edge)));
}

}  // namespace palpate

#include "common/view/straighten.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "common/geometry/direction.hpp"
#include "common/geometry/principal_axes.hpp"
#include "common/mesh/shell_quality.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

std::vector<Eigen::Vector3f> along_longest_extent(const SurfaceMap& surface) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : surface.position) mean += p / surface.size();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : surface.position) spread += (p - mean) * (p - mean).transpose();
  const Eigen::Matrix3d axes = principal_axes(spread).axes;
  std::vector<Eigen::Vector3f> out;
  for (const Vector3d& p : surface.position) out.push_back((axes.transpose() * (p - mean)).cast<float>());
  return out;
}

/// A piece of the centre line with the frame that was carried along it.
struct Piece {
  Vector3d begin, along;  ///< [m], unit
  double length, start;   ///< [m] its own; of the line before it
  Vector3d x;             ///< unit, across
};

std::vector<Piece> centre_line(const std::vector<TubeSection>& sections) {
  std::vector<Piece> pieces;
  double start = 0;
  for (std::size_t i = 0; i + 1 < sections.size(); ++i) {
    const Vector3d step = sections[i + 1].centre - sections[i].centre;
    const double length = step.norm();
    if (!(length > 0)) continue;
    const Vector3d along = step / length;
    const Vector3d x =
        pieces.empty() ? along.unitOrthogonal() : Vector3d(turn_between(pieces.back().along, along) * pieces.back().x);
    pieces.push_back({sections[i].centre, along, length, start, x});
    start += length;
  }
  return pieces;
}

Vector3d on_line(const std::vector<Piece>& pieces, const Vector3d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  Vector3d out = Vector3d::Zero();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Piece& piece = pieces[i];
    double s = piece.along.dot(p - piece.begin);
    if (i > 0) s = std::max(s, 0.0);
    if (i + 1 < pieces.size()) s = std::min(s, piece.length);
    const Vector3d across = p - piece.begin - s * piece.along;
    if (across.squaredNorm() >= nearest) continue;
    nearest = across.squaredNorm();
    out = {piece.x.dot(across), piece.along.cross(piece.x).dot(across), piece.start + s};
  }
  return out;
}

}  // namespace

std::vector<Eigen::Vector3f> straighten(const SurfaceMap& surface) {
  if (boundary_loops(surface.triangles).size() != 2) return along_longest_extent(surface);
  ShellMesh mesh;
  mesh.nodes = surface.position;
  mesh.triangles = surface.triangles;
  const std::vector<Piece> pieces = centre_line(tube_sections(mesh));
  std::vector<Eigen::Vector3f> out;
  for (const Vector3d& p : surface.position) out.push_back(on_line(pieces, p).cast<float>());
  return out;
}

}  // namespace palpate

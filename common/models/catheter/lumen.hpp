#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "common/contact/wall.hpp"

namespace palpate {

/// Which particles are in the duct's lumen. A particle goes in and out through a mouth alone: the fan of
/// triangles from the middle of a boundary loop to its edges, which moves with the wall. What passes through
/// the wall itself stays what it is, and the wall pushes it back.
class Lumen {
 public:
  /// Finds the mouths' orientation and, by solid angles, the particles that are inside. Throws
  /// std::runtime_error where the wall has no mouth, or a mouth is too narrow for the catheter. No wall:
  /// nothing is inside.
  Lumen(const DuctWall* wall, std::span<const Eigen::Vector3d> x, double radius);

  std::span<const char> inside() const { return inside_; }
  std::span<char> inside() { return inside_; }

  /// Follows the mouths from where they were at the last call to where they are, past resting particles.
  void follow_mouths(std::span<const Eigen::Vector3d> x);
  /// Follows the particles past resting mouths.
  void follow_particles(std::span<const Eigen::Vector3d> before, std::span<const Eigen::Vector3d> now);

  /// Neighbours are on one side unless a mouth lies between them: what was missed while the wall was thrown about is
  /// put right, from tail to tip. Where the wall itself lies between them, behind any mouth, nothing is known.
  void follow_chain(std::span<const Eigen::Vector3d> x);

  /// Mouth on whose rim a point of a triangle lies, -1 for all others.
  int rim_at(int triangle, const Eigen::Vector3d& weights) const;
  /// Whether p, nearest to this mouth's rim at q, has left the lumen there: before the mouth and beside it.
  bool past_rim(int mouth, const Eigen::Vector3d& p, const Eigen::Vector3d& q) const;
  /// Whether p lies before a mouth, no farther from its middle than half beyond its radius: from there the
  /// inner side shows.
  bool before_mouth(const Eigen::Vector3d& p) const;
  /// The last crossing of a mouth on a straight way; from_outside: into the lumen.
  std::optional<SweptHit> crossing(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
  void leave(int particle) { inside_[particle] = 0; }
  /// Particles about which no wall is left within reach are out, however they came there: a wall that is thrown about
  /// by several times its width may lose them. Looks at one particle a call.
  void release_lost(std::span<const Eigen::Vector3d> x);

  double inserted(std::span<const Eigen::Vector3d> x, double spacing) const;  ///< [m]

  /// Nodes of the mouths where they were last seen, for the state.
  std::span<Eigen::Vector3d> seen() { return seen_; }
  std::span<const Eigen::Vector3d> seen() const { return seen_; }
  void refresh();  ///< after seen() was restored
  int& turn() { return turn_; }
  const int& turn() const { return turn_; }

  /// [1] 1 inside the wall closed by its mouths, 0 outside (solid angle over 4 pi).
  double winding(const Eigen::Vector3d& p) const;

 private:
  struct Cap {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
    double radius = 0, depth = 0;  ///< [m] about the middle; unevenness along the normal
  };
  struct Mouth {
    std::vector<int> nodes;  ///< a cap of triangles (middle, nodes[i], nodes[i+1]) looks out of the lumen
    int first = 0;           ///< in seen_
    Cap cap;
  };
  bool cuts_wall(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double after) const;  ///< share of the way
  void orient(Mouth& mouth);
  Cap measure(const Mouth& mouth, std::span<const Eigen::Vector3d> nodes) const;
  void check_width(const Mouth& mouth, double radius) const;
  /// The last crossing of a mouth's fan, which goes from the one last seen to the present one.
  std::optional<SweptHit> crossing(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Mouth& mouth,
                                   const Cap& was, std::span<const Eigen::Vector3d> last_nodes) const;
  void cross(int particle, const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Mouth& mouth, const Cap& was,
             std::span<const Eigen::Vector3d> last_nodes);

  const DuctWall* wall_;
  std::vector<Mouth> mouths_;
  std::vector<Eigen::Vector3d> seen_,
      last_;  ///< the mouths' nodes, one mouth after the other, now and at the call before
  std::vector<std::array<int, 3>>
      edge_mouth_;               ///< per triangle, of the edges opposite to its corners; -1: an inner edge
  std::vector<int> node_mouth_;  ///< per surface node; -1: not on a rim
  std::vector<char> inside_;
  double reach_ = 0;  ///< [m] within which a particle in the lumen has a wall
  int turn_ = 0;      ///< particle that release_lost() looks at next
};

}  // namespace palpate

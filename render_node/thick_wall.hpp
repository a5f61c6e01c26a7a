#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace palpate {

/// Both sides of a thin wall and the rims of its openings, from its middle surface: together a closed surface, outward.
class ThickWall {
 public:
  /// A side, or more: its own vertices.
  struct Side {
    std::vector<Eigen::Vector3f> position, normal;  ///< [m], unit
    std::vector<std::array<int, 3>> triangles;      ///< outward, that is, away from the wall's inside
    std::vector<int> from;                          ///< per vertex: the one of the middle surface that it belongs to
  };

  ThickWall() = default;
  /// `triangles` of the middle surface over `vertices` vertices, oriented alike; `thickness` [m].
  ThickWall(std::span<const std::array<int, 3>> triangles, int vertices, double thickness);

  /// Follows the middle surface: position [m] and unit normal per vertex.
  void place(std::span<const Eigen::Vector3f> position, std::span<const Eigen::Vector3f> normal);

  const Side& outer() const { return outer_; }  ///< where the normals point
  const Side& inner() const { return inner_; }  ///< the other side, and the rims

 private:
  struct Rim {
    int vertex;         ///< of the middle surface
    int before, after;  ///< its neighbours along the opening, in the triangles' direction
  };
  void add_rims(std::span<const std::array<int, 3>> triangles);

  float half_ = 0;
  int vertices_ = 0;
  Side outer_, inner_;
  std::vector<Rim>
      rims_;  ///< each has two vertices of the inner side, from 2 * its place on beyond the middle surface's
};

}  // namespace palpate

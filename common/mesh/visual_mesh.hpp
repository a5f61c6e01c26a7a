#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/mesh/visual_spec.hpp"

namespace palpate {

/// A surface to be looked at, of several materials.
struct VisualMesh {
  /// Triangles of one material, with vertices of their own.
  struct Part {
    std::string material;                         ///< its name; empty: none is said
    std::optional<std::array<double, 3>> colour;  ///< linear RGB; absent: the tissue's
    bool textured = false;                        ///< wears the image
    int first = 0, count = 0;                     ///< its vertices
    std::vector<std::array<int, 3>> triangles;    ///< of its vertices, counted from `first`; outward
  };
  std::vector<Eigen::Vector3f> position;  ///< [m] per vertex, at rest
  std::vector<Eigen::Vector2f> image;     ///< per vertex, from the image's upper left corner; 1: its width, its height
  std::vector<int> node;                  ///< per vertex: those at one place have one node, and one normal
  int nodes = 0;
  std::vector<Part> parts;

  std::size_t triangles() const {
    std::size_t sum = 0;
    for (const Part& part : parts) sum += part.triangles.size();
    return sum;
  }
};

/// Of one visual surface, and pixels of a side of its image.
inline constexpr std::size_t kMaxVisualTriangles = 200'000;
inline constexpr int kMaxTextureSide = 4096;

/// Finds what vertices lie at one place: fills in `node` and `nodes`.
void join_places(VisualMesh& mesh);

/// Reads what a scene says of a visual surface, but for its image; positions from `origin` [m] on. Throws
/// std::runtime_error("FILE:LINE: sentence") or ("FILE: sentence").
VisualMesh load_visual_mesh(const VisualSpec& spec, const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());

}  // namespace palpate

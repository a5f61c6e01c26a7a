#pragma once
#include <Eigen/Core>
#include <vector>

namespace palpate {

/// How a body looks.
struct Appearance {
  enum class Material { tissue, wall, plastic };  ///< a wall has two sides
  Material material = Material::tissue;
  double thickness = 0;                  ///< [m] of a wall
  std::vector<Eigen::Vector3f> texture;  ///< [m] coordinates that the texture sticks to, per surface node; empty: rest
};

}  // namespace palpate

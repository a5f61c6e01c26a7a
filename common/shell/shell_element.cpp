#include "common/shell/shell_element.hpp"

#include <cmath>

#include "common/shell/membrane.hpp"

namespace palpate {
namespace {

// Places among a corner's six local dofs: displacements x y z, rotations x y z.
constexpr std::array<int, 3> kMembraneDofs{0, 1, 5}, kBendingDofs{2, 3, 4};

void add_part(const Matrix9d& part, const std::array<int, 3>& places, ShellStiffness& local) {
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) local(6 * (i / 3) + places[i % 3], 6 * (j / 3) + places[j % 3]) += part(i, j);
}

}  // namespace

ShellStiffness shell_element_stiffness(const std::array<Eigen::Vector3d, 3>& corners, const ShellMaterial& material,
                                       Bending bending) {
  const auto [axes, flat] = triangle_frame(corners);
  const Eigen::Matrix3d elasticity = plane_stress(material.young, material.poisson);
  const double t = material.thickness;
  ShellStiffness stiffness = ShellStiffness::Zero();
  add_part(membrane_stiffness(flat, t * elasticity, material.poisson), kMembraneDofs, stiffness);
  add_part(bending_stiffness(bending, flat, t * t * t / 12 * elasticity), kBendingDofs, stiffness);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      auto block = stiffness.block<3, 3>(3 * i, 3 * j);
      block = (axes.transpose() * block * axes).eval();
    }
  return stiffness;
}

}  // namespace palpate

#pragma once
#include "common/shell/bending.hpp"
#include "common/shell/shell_dofs.hpp"

namespace palpate {

using ShellStiffness = Eigen::Matrix<double, 18, 18>;

/// Stiffness of a flat shell triangle in the world frame (BHS01 eqs. 5-13): membrane_stiffness and
/// bending_stiffness side by side, turned. Dofs per corner: displacements along the world's x, y, z [m], then
/// rotations about them [rad]; entries [N/m, N, N m]. Throws std::runtime_error with the reason alone if the
/// corners lie on a line or the bending element is singular.
ShellStiffness shell_element_stiffness(const std::array<Eigen::Vector3d, 3>& corners, const ShellMaterial& material,
                                       Bending bending);

}  // namespace palpate

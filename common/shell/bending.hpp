#pragma once
#include "common/shell/flat_triangle.hpp"
#include "common/shell/spec.hpp"

namespace palpate {

/// Both have the dofs w [m] along the local z, and the rotations [rad] about the local x and y, theta_x =
/// dw/dy and theta_y = -dw/dx, corner by corner. `rigidity` [N m]: plane stress times thickness cubed
/// over 12.

/// Discrete-Kirchhoff triangle (Batoz, Bathe and Ho 1980, International Journal for Numerical Methods in
/// Engineering 15, 1771): the slopes are quadratic, equal dw/dx and dw/dy at the corners, and at the middle
/// of a side the slope along it is that of the cubic through its ends, the slope across it the mean of the
/// ends.
Matrix9d discrete_kirchhoff_stiffness(const FlatTriangle& triangle, const Eigen::Matrix3d& rigidity);

/// w = a1 + a2 x + a3 y + a4 x^2 + a5 xy + a6 y^2 + a7 x^3 + a8 (x^2 y + x y^2) + a9 y^3, integrated exactly
/// and not by the table of BHS01 app. A. It depends on which corner comes first, and neighbours' slopes
/// across a common side differ. With the paper's axes (y along 1-2) the interpolation's determinant is x3^5
/// y2^5 (x3 + 2 y3 - y2). Throws std::runtime_error where the last factor is less than a thousandth of the
/// longest side: such a triangle cannot bend.
Matrix9d polynomial_stiffness(const FlatTriangle& triangle, const Eigen::Matrix3d& rigidity);

Matrix9d bending_stiffness(Bending bending, const FlatTriangle& triangle, const Eigen::Matrix3d& rigidity);

}  // namespace palpate

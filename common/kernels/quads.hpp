#pragma once

/// Elements of tissue in groups of four, one per vector lane. Displacements and forces have four entries a
/// node: x, y, z and one that is and stays zero.
namespace palpate::kernels {

/// Four springs (RR3510 eq. 7). A lane without a spring has stiffness 0, length 1 and any other numbers that
/// are finite.
template <class T>
struct SpringQuad {
  T rest[3][4];          ///< [m] from the first to the second end at rest, axis by axis
  T length[4];           ///< [m] at rest, > 0
  T stiffness[4];        ///< [N/m]
  unsigned entry[2][4];  ///< 4 * node of the first and second end
};

/// Four tetrahedra of corotated linear elasticity. A lane without one has stiffness 0 and equal corners.
template <class T>
struct TetQuad {
  T gradient[3][3][4];   ///< [1/m] [corner - 1][axis]: rest gradients of the shape functions of corners 1, 2, 3
  T shear[4];            ///< 2 mu V [J]
  T volume[4];           ///< lambda V [J]
  unsigned entry[4][4];  ///< 4 * node [corner][lane]
};

}  // namespace palpate::kernels

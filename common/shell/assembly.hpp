#pragma once
#include <vector>

#include "common/fem/assembly.hpp"
#include "common/mesh/shell_mesh.hpp"
#include "common/shell/bending.hpp"
#include "common/shell/shell_dofs.hpp"

namespace palpate {

/// Lower triangle of the stiffness matrix over the free dofs [N/m, N, N m]: membrane with drilling rotations,
/// plus bending. Throws std::runtime_error("WHERE: triangle N: reason") on a triangle, counted from 0, whose
/// corners lie on a line or which the bending element cannot have.
SparseMatrix assemble_shell_stiffness(const ShellMesh& mesh, const ShellMaterial& material, Bending bending,
                                      const ShellDofs& dofs, const std::string& where);

/// A third of each triangle's mass at its corners [kg], per mesh node.
std::vector<double> lumped_shell_mass(const ShellMesh& mesh, const ShellMaterial& material);

/// 1 where a triangle uses the node.
std::vector<char> used_shell_nodes(const ShellMesh& mesh);

}  // namespace palpate

#pragma once
#include "common/mesh/shell_mesh.hpp"
#include "common/shell/assembly.hpp"

namespace palpate {

/// What the motion of a shell needs: M u'' + K u = f over its free dofs, rotations without mass.
struct ShellSystem {
  ShellDofs dofs;
  SparseMatrix stiffness;  ///< lower triangle over the free dofs, translations first
  Eigen::VectorXd mass;    ///< [kg] lumped, per free translation

  int translations() const { return dofs.translations(); }
};

/// Throws as assemble_shell_stiffness() does.
ShellSystem make_shell_system(const ShellMesh& mesh, const ShellMaterial& material, Bending bending, ShellDofs dofs,
                              const std::string& where);

}  // namespace palpate

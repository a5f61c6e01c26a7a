#pragma once
#include <string>
#include <vector>

#include "common/mesh/shell_mesh.hpp"
#include "common/shell/shell_dofs.hpp"
#include "common/shell/spec.hpp"

namespace palpate {

/// Node numbers that a selector names, ascending, each once; nodes that no triangle uses are left out.
/// `where` names the place in error sentences. Throws std::runtime_error on a number out of range or an
/// unknown group.
std::vector<int> select_nodes(const ShellMesh& mesh, const Selector& selector, const std::string& where);

/// Applies the boundary conditions of a shell: translations along the axes named, and all three rotations where the
/// region holds them. `where` starts the error sentences. Throws std::runtime_error if a region selects
/// nothing, or if the fixed dofs leave one of the six rigid-body motions.
ShellDofs apply_boundary_conditions(const ShellMesh& mesh, const ShellSpec& body, const std::string& where);

/// What a modal_shell body must fulfil on its mesh: a wall not thicker than the radius (of a tube its
/// lumen_radius(), else half the mesh's largest extent) and not thinner than a ten-thousandth of the mean edge, and
/// not more modes than free translations. `where` starts the error sentences. Throws std::runtime_error.
void check_shell(const ShellSpec& body, const ShellMesh& mesh, const ShellDofs& dofs, const std::string& where);

}  // namespace palpate

#pragma once
#include "common/archive/archive.hpp"
#include "common/fem/condensation.hpp"
#include "common/fem/static_loads.hpp"
#include "common/mesh/shell_mesh.hpp"
#include "common/models/modal_shell/spec.hpp"
#include "common/shell/shell_system.hpp"

namespace palpate {

/// Geometry and numbering of a shell's nodes, all of which are visible: touchable ones first. Throws
/// std::runtime_error if no node is touchable.
SurfaceMap make_surface_map(const ShellSpec& body, const ShellMesh& mesh, const ShellDofs& dofs);

/// Its [[body.load]] on a mesh. Throws std::runtime_error as body_loads() does.
StaticLoads shell_loads(const ShellSpec& body, const ShellMesh& mesh);

/// Stiffness and mass of the body on a mesh. Throws std::runtime_error on an unfixed body, a wall too thick, or
/// triangles that the bending element cannot have. `where` begins the sentences.
ShellSystem shell_system(const ModalShellSpec& body, const ShellMesh& mesh, const std::string& where);

/// The archive of a modal_shell body: its lowest modes, and the static compliance among its translations,
/// rotations condensed (BHS01 eq. 16, 19), so that C - Phi Omega^-2 Phi^T is the flexibility of the modes
/// left out. The content hash is left empty: see ensure_archive(). Throws std::runtime_error on an unfixed
/// body, empty selections, a wall too thick, more modes than free displacements, triangles that the bending
/// element cannot have, or too little memory.
Archive precompute(const ModalShellSpec& body, const ShellMesh& mesh, const Progress& progress = {});

}  // namespace palpate

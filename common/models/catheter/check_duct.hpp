#pragma once
#include "common/mesh/shell_mesh.hpp"
#include "common/models/catheter/spec.hpp"
#include "common/shell/spec.hpp"

namespace palpate {

/// What a catheter asks of the shell that it is led into: a tube with two mouths that is wider than it is. Throws
/// std::runtime_error("FILE: reason"), FILE being the shell's mesh.
void check_duct(const CatheterSpec& wire, const ShellSpec& duct, const ShellMesh& mesh);

}  // namespace palpate

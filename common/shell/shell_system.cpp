#include "common/shell/shell_system.hpp"

namespace palpate {

ShellSystem make_shell_system(const ShellMesh& mesh, const ShellMaterial& material, Bending bending, ShellDofs dofs,
                              const std::string& where) {
  ShellSystem system{std::move(dofs), {}, {}};
  system.stiffness = assemble_shell_stiffness(mesh, material, bending, system.dofs, where);
  const auto node_mass = lumped_shell_mass(mesh, material);
  system.mass.resize(system.translations());
  for (int i = 0; i < system.translations(); ++i) system.mass[i] = node_mass[system.dofs.dof(i) / 6];
  return system;
}

}  // namespace palpate

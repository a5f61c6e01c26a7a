#include "common/models/vibration.hpp"

#include <fmt/format.h>

#include "common/mesh/shell_file.hpp"
#include "common/models/modal_shell/precompute.hpp"

namespace palpate {

FreeVibration vibration(const ModalShellSpec& body) {
  const ShellMesh mesh = load_shell_mesh(body.mesh, body.scale);
  const ShellSystem system = shell_system(body, mesh, fmt::format("body '{}'", body.name));
  return {system.stiffness, system.mass};
}

}  // namespace palpate

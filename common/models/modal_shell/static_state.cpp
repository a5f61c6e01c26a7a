#include "common/models/static_state.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "common/models/modal_shell/spec.hpp"

namespace palpate {

// A shell's rotations are condensed into its archive, and only there.
DirectProblem direct_problem(const ModalShellSpec& body) {
  throw std::runtime_error(
      fmt::format("body '{}' is a shell, and the direct method is for tetrahedra: take --method tensors", body.name));
}

}  // namespace palpate

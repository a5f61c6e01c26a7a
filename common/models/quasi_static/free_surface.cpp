#include "common/models/quasi_static/free_surface.hpp"

#include "common/models/check/surface_check.hpp"
#include "common/models/quasi_static/compress.hpp"
#include "common/models/quasi_static/spec.hpp"
#include "common/models/solid/precompute.hpp"

namespace palpate {

SurfaceMap free_surface(const TetMesh& mesh) {
  DofMap dofs(mesh);
  if (const auto held = mesh.groups.find(kHeldBy); held != mesh.groups.end())
    for (const int node : held->second.nodes)
      for (int axis = 0; axis < 3; ++axis) dofs.fix(node, axis);
  dofs.number();
  return make_surface_map(QuasiStaticSpec{}, mesh, dofs);
}

std::vector<MemoryPart> free_surface_memory(const SurfaceMap& surface) {
  constexpr int kFields = 3;  // position, displacement, normal
  const std::vector<Tool> tools(1);
  const ContactSpec contact;
  const CheckSettings settings{
      .contact = contact, .tools = tools, .script = {}, .dt = 1e-3, .stored = {}, .find_wall = {}, .check_guests = {}};
  const bool compressed = form_of(surface.touchable) == TensorForm::compressed;
  return compliance_memory(settings, surface, 0, kFields, compressed ? compressed_bytes(surface) : 0);
}

}  // namespace palpate

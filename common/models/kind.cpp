#include "common/models/kind.hpp"

#include "common/archive/archive.hpp"
#include "common/archive/scale_young.hpp"
#include "common/fem/solid_spec.hpp"
#include "common/models/appearance.hpp"
#include "common/shell/spec.hpp"

namespace palpate {

Appearance appearance(const NamedSpec&, const SurfaceMap&) {
  return {};
}

Appearance appearance(const ShellSpec& body, const SurfaceMap&) {
  return {.material = Appearance::Material::wall, .thickness = body.shell.thickness, .texture = {}};
}

std::filesystem::path mesh_file(const NamedSpec&) {
  return {};
}

std::filesystem::path mesh_file(const MeshedSpec& body) {
  return body.mesh;
}

const VisualSpec* visual_of(const SolidSpec& body) {
  return body.visual ? &*body.visual : nullptr;
}

void fit_archive(const MeshedSpec& body, Archive& archive) {
  scale_young(archive, body.material.young);
  for (std::size_t n = 0; n < archive.sag.size(); ++n) archive.surface.position[n] += archive.sag[n];
}

std::optional<Archive> made_archive(const MeshedSpec&) {
  return {};
}

}  // namespace palpate

#include "common/archive/archive_modal.hpp"

#include <algorithm>

namespace palpate {

void write_modal_part(Hdf5Writer& file, const Archive& archive) {
  if (!archive.modal) return;
  const ModalTensors& modal = *archive.modal;
  file.attribute("shell_thickness", modal.thickness);
  file.dataset({"modal/omega", "rad/s", "frequency of each mode, ascending"}, modal.omega);
  file.dataset({"modal/shape", "kg^-1/2",
                "displacement of x, y, z of every surface node (column) per coordinate of a mode (row), "
                "phi^T M phi = 1"},
               modal.shape, std::max<std::size_t>(3 * archive.surface.position.size(), 1));
  file.dataset({"modal/mass", "kg", "lumped mass of each surface node"}, modal.mass);
}

void read_modal_part(const Hdf5Reader& file, ArchivePart part, Archive& archive) {
  if (!file.has_attribute("shell_thickness")) return;
  ModalTensors& modal = archive.modal.emplace();
  modal.thickness = file.number("shell_thickness");
  modal.omega = file.doubles("modal/omega", kAboveZero);
  modal.mass = file.doubles("modal/mass", kAboveZero);
  if (part != ArchivePart::header) modal.shape = file.doubles("modal/shape");
}

bool modal_part_fits(const Archive& archive, ArchivePart part) {
  if (archive.modal.has_value() != archive.parts.modal) return false;
  if (!archive.modal) return true;
  const ModalTensors& modal = *archive.modal;
  const std::size_t nodes = archive.surface.position.size();
  const bool shapes = part == ArchivePart::header || modal.shape.size() == 3 * nodes * modal.omega.size();
  return shapes && modal.mass.size() == nodes && modal.modes() > 0 && modal.thickness > 0 &&
         std::is_sorted(modal.omega.begin(), modal.omega.end());
}

std::size_t modal_payload_bytes(const Archive& archive) {
  if (!archive.modal) return 0;
  return sizeof(double) * (archive.modal->omega.size() + archive.modal->shape.size() + archive.modal->mass.size());
}

}  // namespace palpate

#include "common/archive/archive.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/archive/archive_compressed.hpp"
#include "common/archive/archive_dynamic.hpp"
#include "common/archive/archive_modal.hpp"
#include "common/archive/archive_presses.hpp"
#include "common/archive/fits.hpp"
#include "common/archive/hdf5_file.hpp"
#include "common/archive/rows.hpp"
#include "common/files/atomic_file.hpp"

namespace palpate {
namespace {

constexpr const char* kFormat = "palpate compliance archive";
constexpr std::size_t kMetadataBytes = 64 * 1024;
constexpr std::size_t kMaxMaterials = 1 << 16;  // of_element holds 16 bits

std::size_t payload_bytes(const Archive& archive) {
  const auto& surface = archive.surface;
  const std::size_t doubles = archive.touchable_compliance.size() + archive.other_compliance.size() +
                              3 * surface.position.size() + 3 * archive.young.size() + 3 * archive.sag.size() +
                              3 * archive.load.size();
  const std::size_t integers = 4 * surface.position.size() + 3 * surface.triangles.size() +
                               2 * (archive.touchable_dofs.size() + archive.other_dofs.size()) +
                               archive.material_of_element.size();
  return sizeof(double) * doubles + sizeof(std::int32_t) * integers + dynamic_payload_bytes(archive) +
         modal_payload_bytes(archive) + presses_payload_bytes(archive) + compressed_payload_bytes(archive);
}

void write_header(Hdf5Writer& file, const Archive& archive) {
  file.attribute("format", kFormat);
  file.attribute("format_version", std::int64_t{kArchiveFormat});
  file.attribute("software", archive.software);
  file.attribute("body", archive.body);
  file.attribute("model", archive.model);
  file.attribute("has_dynamic", std::int64_t{archive.parts.dynamic});
  file.attribute("has_hybrid", std::int64_t{archive.parts.condensed});
  file.attribute("has_modal", std::int64_t{archive.parts.modal});
  file.attribute("content_hash", archive.content_hash);
  file.attribute("mesh_nodes", std::int64_t{archive.mesh_nodes});
  file.attribute("touchable_nodes", std::int64_t{archive.surface.touchable});
  file.attribute("specimen_force_slope", archive.specimen_force_slope);
  file.attribute("specimen_radial_slope", archive.specimen_radial_slope);
}

void write_surface(Hdf5Writer& file, const Archive& archive) {
  const SurfaceMap& surface = archive.surface;
  file.dataset({"surface/position", "m",
                "rest position of each node, touchable ones first, then the rest of the surface, then inner ones"},
               flatten(surface.position, 3, [](const auto& row, std::size_t c) { return double{row[c]}; }), 3);
  file.dataset({"surface/node_number", "1", "0-based node number in the mesh file of each node"},
               std::vector<std::int32_t>(surface.node_number.begin(), surface.node_number.end()));
  file.dataset({"surface/fixed", "1", "1 where x, y, z of a node is fixed"},
               flatten(surface.fixed, 3, [](const auto& row, std::size_t c) { return std::int32_t{row[c]}; }), 3);
  file.dataset({"surface/sag", "m", "displacement of each node under the body's dead loads and weight; absent: none"},
               flatten(archive.sag, 3, [](const auto& row, std::size_t c) { return double{row[c]}; }), 3);
  file.dataset({"surface/load", "N", "dead load on each node of what moves with inertia; absent: none"},
               flatten(archive.load, 3, [](const auto& row, std::size_t c) { return double{row[c]}; }), 3);
  file.dataset({"surface/triangles", "1", "surface nodes of each triangle, outward by the right-hand rule"},
               flatten(surface.triangles, 3, [](const auto& row, std::size_t c) { return std::int32_t{row[c]}; }), 3);
}

void write_material(Hdf5Writer& file, const Archive& archive) {
  file.dataset({"material/young", "Pa", "Young's modulus of the body, then of its material regions"}, archive.young);
  file.dataset({"material/poisson", "1", "Poisson's ratio of the body, then of its material regions"}, archive.poisson);
  file.dataset({"material/density", "kg/m^3", "density of the body, then of its material regions"}, archive.density);
  file.dataset({"material/of_element", "1",
                "row of material/young for each tetrahedron (of dynamic/tetrahedra if there); absent: 0 for all"},
               std::vector<std::int32_t>(archive.material_of_element.begin(), archive.material_of_element.end()));
}

void write_compliance(Hdf5Writer& file, const Archive& archive) {
  file.dataset({"touchable/dofs", "1", "surface node and axis of each row of the touchable compliance"},
               flatten(archive.touchable_dofs), 2);
  file.dataset({"other/dofs", "1", "surface node and axis of each row of the other compliance"},
               flatten(archive.other_dofs), 2);
  file.dataset({"touchable/compliance", "m/N",
                "displacement of touchable dof i per force on touchable dof j; lower triangle packed by rows, "
                "entry (i,j), j <= i, at i(i+1)/2 + j"},
               archive.touchable_compliance);
  file.dataset({"other/compliance", "m/N", "displacement of other dof i (row) per force on touchable dof j (column)"},
               archive.other_compliance, std::max<std::size_t>(archive.touchable_dofs.size(), 1));
}

SurfaceMap read_surface(const Hdf5Reader& file) {
  SurfaceMap surface;
  surface.position = rows_of<Eigen::Vector3d>(3, file.doubles("surface/position"));
  const auto numbers = file.integers("surface/node_number");
  surface.node_number.assign(numbers.begin(), numbers.end());
  surface.fixed = rows_of<std::array<bool, 3>>(3, file.integers("surface/fixed"));
  surface.triangles = rows_of<std::array<int, 3>>(3, file.integers("surface/triangles"));
  surface.touchable = file.count("touchable_nodes");
  return surface;
}

void read_material(const Hdf5Reader& file, Archive& archive) {
  archive.young = file.doubles("material/young", kAboveZero);
  archive.poisson = file.doubles("material/poisson", strictly_within(-1, 0.5));
  archive.density = file.doubles("material/density", kAboveZero);
  const auto material = file.integers("material/of_element");
  const auto known = static_cast<int>(std::min<std::size_t>(archive.young.size(), kMaxMaterials));
  if (!std::ranges::all_of(material, [&](int row) { return within(row, known); }))
    file.fail("damaged: 'material/of_element' names a material that is not there");
  archive.material_of_element.assign(material.begin(), material.end());
}

void check_identity(const Hdf5Reader& file, const std::string& expected_hash) {
  if (!file.has_attribute("format") || file.text("format") != kFormat) file.fail("not a palpate archive");
  const auto version = file.integer("format_version");
  if (version != kArchiveFormat)
    file.fail(fmt::format("format version {}, this program reads {}", version, kArchiveFormat));
  if (!expected_hash.empty() && file.text("content_hash") != expected_hash)
    file.fail("made for another mesh, material or boundary conditions");
}

/// Nodes are each of the mesh and there once, and triangles have three.
bool surface_fits(const SurfaceMap& surface, int mesh_nodes) {
  const std::size_t nodes = surface.position.size();
  if (surface.node_number.size() != nodes || surface.fixed.size() != nodes || surface.touchable > surface.size())
    return false;
  std::vector<int> numbers = surface.node_number;
  std::ranges::sort(numbers);
  if (nodes > 0 && (numbers.front() < 0 || numbers.back() >= mesh_nodes)) return false;
  const auto is_triangle = [&](const std::array<int, 3>& t) {
    return all_within(t, surface.size()) && t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
  };
  return std::ranges::adjacent_find(numbers) == numbers.end() && std::ranges::all_of(surface.triangles, is_triangle);
}

bool compliance_fits(const Archive& archive, ArchivePart part) {
  const SurfaceMap& surface = archive.surface;
  const std::size_t touchable = archive.touchable_dofs.size();
  if (!are_free_dofs(archive.touchable_dofs, surface, 0, surface.touchable)) return false;
  if (!are_free_dofs(archive.other_dofs, surface, surface.touchable, surface.size())) return false;
  if (archive.compressed) return archive.touchable_compliance.empty() && archive.other_compliance.empty();
  if (part != ArchivePart::header && !is_packed_compliance(archive.touchable_compliance, touchable)) return false;
  return part != ArchivePart::surface || archive.other_compliance.size() == archive.other_dofs.size() * touchable;
}

/// That its datasets fit together, and that no number in them leads out of another one.
void check_fit(const Hdf5Reader& file, const Archive& archive, ArchivePart part) {
  const auto of_nodes = [&](const auto& list) {
    return list.empty() || list.size() == archive.surface.position.size();
  };
  const bool fits = of_nodes(archive.sag) && of_nodes(archive.load) && !archive.young.empty() &&
                    archive.young.size() == archive.poisson.size() &&
                    surface_fits(archive.surface, archive.mesh_nodes) && compliance_fits(archive, part) &&
                    dynamic_part_fits(archive, part) && modal_part_fits(archive, part) && presses_fit(archive);
  if (!fits) file.fail("damaged: its datasets do not fit together");
}

}  // namespace

void write_archive(const Archive& archive, const std::filesystem::path& file) {
  make_folder_of(file);
  AtomicFile atomic(file, payload_bytes(archive) + kMetadataBytes, AtomicFile::Temporary::named);
  Hdf5Writer writer(atomic.path());
  write_header(writer, archive);
  write_surface(writer, archive);
  write_material(writer, archive);
  write_compliance(writer, archive);
  write_compressed(writer, archive);
  write_dynamic_part(writer, archive);
  write_modal_part(writer, archive);
  write_presses(writer, archive);
  writer.close();
  atomic.commit();
}

Archive read_archive(const std::filesystem::path& file, ArchivePart part, const std::string& expected_hash) {
  const Hdf5Reader reader(file);
  check_identity(reader, expected_hash);
  Archive archive;
  archive.body = reader.text("body");
  archive.model = reader.text("model");
  archive.parts = {
      .dynamic = reader.flag("has_dynamic"), .condensed = reader.flag("has_hybrid"), .modal = reader.flag("has_modal")};
  archive.content_hash = reader.text("content_hash");
  archive.software = reader.text("software");
  archive.mesh_nodes = reader.count("mesh_nodes");
  archive.specimen_force_slope = reader.number("specimen_force_slope");
  archive.specimen_radial_slope = reader.number("specimen_radial_slope");
  read_material(reader, archive);
  archive.surface = read_surface(reader);
  archive.sag = rows_of<Eigen::Vector3d>(3, reader.doubles("surface/sag"));
  archive.load = rows_of<Eigen::Vector3d>(3, reader.doubles("surface/load"));
  archive.touchable_dofs = read_dofs(reader, "touchable/dofs");
  archive.other_dofs = read_dofs(reader, "other/dofs");
  if (part != ArchivePart::header) archive.touchable_compliance = reader.doubles("touchable/compliance");
  if (part == ArchivePart::surface) archive.other_compliance = reader.doubles("other/compliance");
  read_compressed(reader, part, archive);
  read_dynamic_part(reader, part, archive);
  read_modal_part(reader, part, archive);
  read_presses(reader, archive);
  check_fit(reader, archive, part);
  return archive;
}

}  // namespace palpate

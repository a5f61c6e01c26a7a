#include "common/archive/archive_dynamic.hpp"

#include <algorithm>
#include <functional>

#include "common/archive/fits.hpp"
#include "common/archive/rows.hpp"

namespace palpate {
namespace {

void write_gap(Hdf5Writer& file, const CondensedTensors& condensed) {
  file.dataset({"hybrid/gap_nodes", "1",
                "node on one side of a partial connection, and the nodes of the nearest triangle of the other side"},
               flatten(condensed.gap, 4,
                       [](const GapPair& p, std::size_t c) { return std::int32_t{c ? p.triangle[c - 1] : p.node}; }),
               4);
  file.dataset({"hybrid/gap_weights", "1", "barycentric weights of the point opposite to the node"},
               flatten(condensed.gap, 3, [](const GapPair& p, std::size_t c) { return double{p.weights[c]}; }), 3);
}

void write_condensed(Hdf5Writer& file, const CondensedTensors& condensed) {
  file.attribute("hybrid_bound", condensed.bound);
  file.attribute("held_by_connection", std::int64_t{condensed.held_by_connection});
  file.attribute("quasi_static_triangles", std::int64_t{condensed.quasi_static_triangles});
  file.attribute("max_gap", condensed.max_gap);
  file.dataset({"hybrid/connection", "1", "nodes that the quasi-static and the dynamic part share"},
               std::vector<std::int32_t>(condensed.connection.begin(), condensed.connection.end()));
  file.dataset({"hybrid/mass", "kg", "lumped mass of the quasi-static elements at each connection node"},
               condensed.mass);
  file.dataset({"hybrid/interface", "1",
                "faces between the parts: three nodes, outward of the quasi-static part, and the dynamic "
                "facet 4 t + f that covers it"},
               flatten_integers(condensed.interface), 4);
  file.dataset({"hybrid/dofs", "1", "node and axis of each free dof of the connection nodes"}, flatten(condensed.dofs),
               2);
  file.dataset({"hybrid/stiffness", "N/m", "S = K_cc - K_ci K_ii^-1 K_ic; lower triangle packed by rows"},
               condensed.stiffness);
  file.dataset({"hybrid/reaction", "N", "force of the quasi-static part's weight on each connection dof"},
               condensed.reaction);
  file.dataset({"hybrid/follow", "1",
                "H = -K_ii^-1 K_ic: displacement of touchable, then other dofs (row) per displacement of "
                "connection dofs (column)"},
               condensed.follow, std::max<std::size_t>(condensed.dofs.size(), 1));
  file.dataset({"hybrid/sag", "m", "displacement of touchable, then other dofs under the quasi-static part's weight"},
               condensed.sag);
  write_gap(file, condensed);
}

CondensedTensors read_condensed(const Hdf5Reader& file, ArchivePart part) {
  CondensedTensors condensed;
  condensed.bound = file.number("hybrid_bound");
  condensed.held_by_connection = file.flag("held_by_connection");
  condensed.quasi_static_triangles = file.count("quasi_static_triangles");
  condensed.max_gap = file.number("max_gap");
  const auto connection = file.integers("hybrid/connection");
  condensed.connection.assign(connection.begin(), connection.end());
  condensed.mass = file.doubles("hybrid/mass", at_least(0));
  condensed.interface = rows_of<std::array<int, 4>>(4, file.integers("hybrid/interface"));
  condensed.dofs = read_dofs(file, "hybrid/dofs");
  const auto nodes = rows_of<std::array<int, 4>>(4, file.integers("hybrid/gap_nodes"));
  const auto weights = rows_of<std::array<double, 3>>(3, file.doubles("hybrid/gap_weights"));
  if (nodes.size() != weights.size()) file.fail("damaged: its datasets do not fit together");
  for (std::size_t i = 0; i < nodes.size(); ++i)
    condensed.gap.push_back({nodes[i][0], {nodes[i][1], nodes[i][2], nodes[i][3]}, weights[i]});
  if (part != ArchivePart::surface) return condensed;
  condensed.stiffness = file.doubles("hybrid/stiffness");
  condensed.reaction = file.doubles("hybrid/reaction");
  condensed.follow = file.doubles("hybrid/follow");
  condensed.sag = file.doubles("hybrid/sag");
  return condensed;
}

bool connection_fits(const CondensedTensors& condensed, const SurfaceMap& surface) {
  const std::vector<int>& nodes = condensed.connection;
  const bool ascends = std::ranges::adjacent_find(nodes, std::greater_equal<>()) == nodes.end();
  return ascends &&
         (nodes.empty() || (within(nodes.front(), surface.size()) && within(nodes.back(), surface.size()))) &&
         condensed.mass.size() == nodes.size() && are_free_dofs(condensed.dofs, surface, 0, surface.size()) &&
         std::ranges::all_of(condensed.dofs,
                             [&](const Dof& dof) { return std::ranges::binary_search(nodes, dof.node); });
}

bool border_fits(const CondensedTensors& condensed, const Archive& archive) {
  const int nodes = archive.surface.size();
  const auto facets = static_cast<int>(4 * archive.tetrahedra.size());
  for (const auto& [p, q, r, facet] : condensed.interface)
    if (!all_within(std::array{p, q, r}, nodes) || !within(facet, facets)) return false;
  return std::ranges::all_of(
      condensed.gap, [&](const GapPair& pair) { return within(pair.node, nodes) && all_within(pair.triangle, nodes); });
}

bool condensed_fits(const Archive& archive, ArchivePart part) {
  const CondensedTensors& condensed = *archive.condensed;
  const std::size_t c = condensed.dofs.size(), i = archive.touchable_dofs.size() + archive.other_dofs.size();
  const auto triangles = static_cast<int>(archive.surface.triangles.size());
  const bool fits = condensed.bound >= 0 && condensed.quasi_static_triangles <= triangles &&
                    connection_fits(condensed, archive.surface) && border_fits(condensed, archive);
  if (part != ArchivePart::surface) return fits;
  return fits && condensed.stiffness.size() == c * (c + 1) / 2 && condensed.reaction.size() == c &&
         condensed.follow.size() == i * c && condensed.sag.size() == i;
}

}  // namespace

void write_dynamic_part(Hdf5Writer& file, const Archive& archive) {
  file.dataset({"dynamic/tetrahedra", "1", "nodes of each tetrahedron that moves with inertia, positively oriented"},
               flatten_integers(archive.tetrahedra), 4);
  file.dataset({"dynamic/dofs", "1", "node and axis of each free dof of the touchable nodes"},
               flatten(archive.moving_dofs), 2);
  file.dataset({"dynamic/compliance", "m/N",
                "compliance of the whole body at rest among these dofs; lower triangle packed by rows"},
               archive.moving_compliance);
  if (archive.condensed) write_condensed(file, *archive.condensed);
}

void read_dynamic_part(const Hdf5Reader& file, ArchivePart part, Archive& archive) {
  archive.tetrahedra = rows_of<std::array<int, 4>>(4, file.integers("dynamic/tetrahedra"));
  archive.moving_dofs = read_dofs(file, "dynamic/dofs");
  if (part == ArchivePart::surface) archive.moving_compliance = file.doubles("dynamic/compliance");
  if (file.has_attribute("hybrid_bound")) archive.condensed = read_condensed(file, part);
}

bool dynamic_part_fits(const Archive& archive, ArchivePart part) {
  const auto count = archive.tetrahedra.size();
  bool fits = archive.condensed.has_value() == archive.parts.condensed && (count > 0) == archive.parts.dynamic;
  if (count > 0)
    fits &= archive.density.size() == archive.young.size() &&
            (archive.material_of_element.empty() || archive.material_of_element.size() == count);
  fits &= std::ranges::all_of(archive.tetrahedra,
                              [&](const auto& nodes) { return all_within(nodes, archive.surface.size()); });
  fits &= are_free_dofs(archive.moving_dofs, archive.surface, 0, archive.surface.touchable);
  if (part == ArchivePart::surface) fits &= is_packed_compliance(archive.moving_compliance, archive.moving_dofs.size());
  return fits && (!archive.condensed || condensed_fits(archive, part));
}

std::size_t dynamic_payload_bytes(const Archive& archive) {
  std::size_t doubles = archive.moving_compliance.size();
  std::size_t integers = 4 * archive.tetrahedra.size() + 2 * archive.moving_dofs.size();
  if (archive.condensed) {
    const CondensedTensors& h = *archive.condensed;
    doubles +=
        h.mass.size() + h.stiffness.size() + h.reaction.size() + h.follow.size() + h.sag.size() + 3 * h.gap.size();
    integers += h.connection.size() + 4 * h.interface.size() + 2 * h.dofs.size() + 4 * h.gap.size();
  }
  return sizeof(double) * doubles + sizeof(std::int32_t) * integers;
}

}  // namespace palpate

#include "common/archive/archive_dynamic.hpp"

#include <algorithm>

#include "common/archive/rows.hpp"

namespace palpate {
namespace {

void write_gap(Hdf5Writer& file, const HybridTensors& hybrid) {
  file.dataset({"hybrid/gap_nodes", "1",
                "node on one side of a partial connection, and the nodes of the nearest triangle of the other side"},
               flatten(hybrid.gap, 4,
                       [](const GapPair& p, std::size_t c) { return std::int32_t{c ? p.triangle[c - 1] : p.node}; }),
               4);
  file.dataset({"hybrid/gap_weights", "1", "barycentric weights of the point opposite to the node"},
               flatten(hybrid.gap, 3, [](const GapPair& p, std::size_t c) { return double{p.weights[c]}; }), 3);
}

void write_hybrid(Hdf5Writer& file, const HybridTensors& hybrid) {
  file.attribute("hybrid_bound", hybrid.bound);
  file.attribute("held_by_connection", std::int64_t{hybrid.held_by_connection});
  file.attribute("quasi_static_triangles", std::int64_t{hybrid.quasi_static_triangles});
  file.attribute("max_gap", hybrid.max_gap);
  file.dataset({"hybrid/connection", "1", "nodes that the quasi-static and the dynamic part share"},
               std::vector<std::int32_t>(hybrid.connection.begin(), hybrid.connection.end()));
  file.dataset({"hybrid/mass", "kg", "lumped mass of the quasi-static elements at each connection node"}, hybrid.mass);
  file.dataset({"hybrid/interface", "1",
                "faces between the parts: three nodes, outward of the quasi-static part, and the dynamic "
                "facet 4 t + f that covers it"},
               flatten_integers(hybrid.interface), 4);
  file.dataset({"hybrid/dofs", "1", "node and axis of each free dof of the connection nodes"}, flatten(hybrid.dofs), 2);
  file.dataset({"hybrid/stiffness", "N/m", "S = K_cc - K_ci K_ii^-1 K_ic; lower triangle packed by rows"},
               hybrid.stiffness);
  file.dataset({"hybrid/reaction", "N", "force of the quasi-static part's weight on each connection dof"},
               hybrid.reaction);
  file.dataset({"hybrid/follow", "1",
                "H = -K_ii^-1 K_ic: displacement of touchable, then other dofs (row) per displacement of "
                "connection dofs (column)"},
               hybrid.follow, std::max<std::size_t>(hybrid.dofs.size(), 1));
  file.dataset({"hybrid/sag", "m", "displacement of touchable, then other dofs under the quasi-static part's weight"},
               hybrid.sag);
  write_gap(file, hybrid);
}

HybridTensors read_hybrid(const Hdf5Reader& file, ArchivePart part) {
  HybridTensors hybrid;
  hybrid.bound = file.number("hybrid_bound");
  hybrid.held_by_connection = file.integer("held_by_connection") != 0;
  hybrid.quasi_static_triangles = static_cast<int>(file.integer("quasi_static_triangles"));
  hybrid.max_gap = file.number("max_gap");
  const auto connection = file.integers("hybrid/connection");
  hybrid.connection.assign(connection.begin(), connection.end());
  hybrid.mass = file.doubles("hybrid/mass");
  hybrid.interface = rows_of<std::array<int, 4>>(4, file.integers("hybrid/interface"));
  hybrid.dofs = read_dofs(file, "hybrid/dofs");
  const auto nodes = rows_of<std::array<int, 4>>(4, file.integers("hybrid/gap_nodes"));
  const auto weights = rows_of<std::array<double, 3>>(3, file.doubles("hybrid/gap_weights"));
  if (nodes.size() != weights.size()) file.fail("damaged: its datasets do not fit together");
  for (std::size_t i = 0; i < nodes.size(); ++i)
    hybrid.gap.push_back({nodes[i][0], {nodes[i][1], nodes[i][2], nodes[i][3]}, weights[i]});
  if (part != ArchivePart::surface) return hybrid;
  hybrid.stiffness = file.doubles("hybrid/stiffness");
  hybrid.reaction = file.doubles("hybrid/reaction");
  hybrid.follow = file.doubles("hybrid/follow");
  hybrid.sag = file.doubles("hybrid/sag");
  return hybrid;
}

bool within(int node, int nodes) {
  return node >= 0 && node < nodes;
}

bool hybrid_fits(const Archive& archive, ArchivePart part) {
  const HybridTensors& hybrid = *archive.hybrid;
  const int nodes = archive.surface.size(), facets = 4 * static_cast<int>(archive.tetrahedra.size());
  const std::size_t c = hybrid.dofs.size(), i = archive.touchable_dofs.size() + archive.other_dofs.size();
  bool fits = hybrid.mass.size() == hybrid.connection.size() && hybrid.quasi_static_triangles >= 0 &&
              hybrid.quasi_static_triangles <= static_cast<int>(archive.surface.triangles.size());
  for (int node : hybrid.connection) fits &= within(node, nodes);
  for (const Dof& dof : hybrid.dofs)
    fits &= std::binary_search(hybrid.connection.begin(), hybrid.connection.end(), dof.node) && within(dof.axis, 3);
  for (const auto& [p, q, r, facet] : hybrid.interface)
    fits &= within(p, nodes) && within(q, nodes) && within(r, nodes) && within(facet, facets);
  for (const GapPair& pair : hybrid.gap) {
    fits &= within(pair.node, nodes);
    for (int node : pair.triangle) fits &= within(node, nodes);
  }
  if (part != ArchivePart::surface) return fits;
  return fits && hybrid.stiffness.size() == c * (c + 1) / 2 && hybrid.reaction.size() == c &&
         hybrid.follow.size() == i * c && hybrid.sag.size() == i;
}

}  // namespace

void write_dynamic_part(Hdf5Writer& file, const Archive& archive) {
  file.dataset({"dynamic/tetrahedra", "1", "nodes of each tetrahedron that moves with inertia, positively oriented"},
               flatten_integers(archive.tetrahedra), 4);
  file.dataset({"dynamic/dofs", "1", "node and axis of each free dof of their touchable nodes"},
               flatten(archive.moving_dofs), 2);
  file.dataset({"dynamic/compliance", "m/N",
                "compliance of these tetrahedra at rest among their touchable dofs; lower triangle packed by rows"},
               archive.moving_compliance);
  if (archive.hybrid) write_hybrid(file, *archive.hybrid);
}

void read_dynamic_part(const Hdf5Reader& file, ArchivePart part, Archive& archive) {
  archive.tetrahedra = rows_of<std::array<int, 4>>(4, file.integers("dynamic/tetrahedra"));
  archive.moving_dofs = read_dofs(file, "dynamic/dofs");
  if (part == ArchivePart::surface) archive.moving_compliance = file.doubles("dynamic/compliance");
  if (file.has_attribute("hybrid_bound")) archive.hybrid = read_hybrid(file, part);
}

bool dynamic_part_fits(const Archive& archive, ArchivePart part) {
  const auto count = archive.tetrahedra.size();
  bool fits = archive.hybrid.has_value() == archive.parts.hybrid && (count > 0) == archive.parts.dynamic;
  if (count > 0)
    fits &= archive.density.size() == archive.young.size() &&
            (archive.material_of_element.empty() || archive.material_of_element.size() == count);
  for (const auto& tetrahedron : archive.tetrahedra)
    for (int node : tetrahedron) fits &= within(node, archive.surface.size());
  const std::size_t dofs = archive.moving_dofs.size();
  for (const Dof& dof : archive.moving_dofs) fits &= within(dof.node, archive.surface.touchable) && within(dof.axis, 3);
  if (part == ArchivePart::surface) fits &= archive.moving_compliance.size() == dofs * (dofs + 1) / 2;
  return fits && (!archive.hybrid || hybrid_fits(archive, part));
}

std::size_t dynamic_payload_bytes(const Archive& archive) {
  std::size_t doubles = archive.moving_compliance.size();
  std::size_t integers = 4 * archive.tetrahedra.size() + 2 * archive.moving_dofs.size();
  if (archive.hybrid) {
    const HybridTensors& h = *archive.hybrid;
    doubles +=
        h.mass.size() + h.stiffness.size() + h.reaction.size() + h.follow.size() + h.sag.size() + 3 * h.gap.size();
    integers += h.connection.size() + 4 * h.interface.size() + 2 * h.dofs.size() + 4 * h.gap.size();
  }
  return sizeof(double) * doubles + sizeof(std::int32_t) * integers;
}

}  // namespace palpate

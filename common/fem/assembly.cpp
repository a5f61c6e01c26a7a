#include "common/fem/assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "common/fem/nodal_patches.hpp"
#include "common/fem/selection.hpp"

namespace palpate {
namespace {

TetGradients gradients_of(const TetMesh& mesh, const std::array<int, 4>& tet) {
  return tet_gradients({mesh.nodes[tet[0]], mesh.nodes[tet[1]], mesh.nodes[tet[2]], mesh.nodes[tet[3]]});
}

NodalPatches patches_of(const TetMesh& mesh, const MaterialField& materials) {
  return {mesh.nodes, mesh.tetrahedra, materials.materials, materials.of_element, materials.nodal_strain};
}

/// The entry of the graph of a node and one with a lower or equal number.
std::size_t entry_of(const NodeGraph& graph, int greater, int lower) {
  const auto first = graph.neighbour.begin();
  return std::lower_bound(first + graph.begin[lower], first + graph.begin[lower + 1], greater) - first;
}

void add_patches(const NodalPatches& patches, const NodeGraph& graph, std::vector<Eigen::Matrix3d>& blocks) {
  std::vector<NodalPatches::Tie> ties;
  for (int p = 0; p < patches.size(); ++p) {
    const auto nodes = patches.nodes(p);
    ties.resize(nodes.size());
    const double volume = patches.sum(p, {}, ties);
    const Lame& constants = patches.lame(p);
    const double gradient = constants.mu - patches.stabilisation(p);
    for (std::size_t j = 0; j < nodes.size(); ++j)
      for (std::size_t k = 0; k <= j; ++k) {
        const Eigen::Vector3d gj = ties[j].head<3>(), gk = ties[k].head<3>();
        blocks[entry_of(graph, nodes[j], nodes[k])] +=
            (constants.lambda * gj * gk.transpose() + constants.mu * gk * gj.transpose() +
             gradient * gj.dot(gk) * Eigen::Matrix3d::Identity()) /
            volume;
      }
    for (std::size_t j = 0; j < nodes.size(); ++j)
      if (nodes[j] >= patches.node(p))
        blocks[entry_of(graph, nodes[j], patches.node(p))].diagonal().array() += ties[j][3];
  }
}

/// The stiffness as one 3 x 3 block (rows the greater node) per entry of the node graph.
std::vector<Eigen::Matrix3d> assemble_blocks(const TetMesh& mesh, const MaterialField& materials,
                                             const NodeGraph& graph) {
  std::vector<Eigen::Matrix3d> blocks(graph.neighbour.size(), Eigen::Matrix3d::Zero());
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    if (materials.averages(e)) continue;
    const auto& tet = mesh.tetrahedra[e];
    const auto gradients = gradients_of(mesh, tet);
    const auto constants = lame(materials.at(static_cast<int>(e)));
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k)
        if (tet[j] >= tet[k]) blocks[entry_of(graph, tet[j], tet[k])] += stiffness_block(gradients, constants, j, k);
  }
  if (!materials.nodal_strain.empty()) add_patches(patches_of(mesh, materials), graph, blocks);
  return blocks;
}

void add_patch_forces(const NodalPatches& patches, const std::vector<Eigen::Vector3d>& u,
                      std::vector<Eigen::Vector3d>& force) {
  std::vector<NodalPatches::Tie> ties;
  for (int p = 0; p < patches.size(); ++p) {
    const auto nodes = patches.nodes(p);
    const Eigen::Vector3d& own = u[patches.node(p)];
    ties.resize(nodes.size());
    const double volume = patches.sum(p, {}, ties);
    Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      s += (u[nodes[j]] - own) * ties[j].head<3>().transpose();
      force[patches.node(p)] += ties[j][3] * (u[nodes[j]] - own);
    }
    const Eigen::Matrix3d stress = patch_stress(patches.lame(p), patches.stabilisation(p), volume, s);
    for (std::size_t j = 0; j < nodes.size(); ++j) force[nodes[j]] += stress * ties[j].head<3>();
  }
}

constexpr double kMaxContrast = 1e10;  // [1] of Young's moduli: beyond it rounding in the stiff part hides the soft one

void refuse_contrast(const MaterialField& field, const std::string& body) {
  const auto young = [&](std::uint16_t m) { return field.materials[m].young; };
  const auto [soft, stiff] = std::ranges::minmax(field.of_element, {}, young);
  const double least = young(soft), most = young(stiff);
  if (most > kMaxContrast * least)
    throw std::runtime_error(
        fmt::format("body '{}': its materials have Young's moduli from {:.3g} to {:.3g} Pa, a contrast of {:.3g}: "
                    "more than {:g} and the soft part is lost in the stiff one's rounding",
                    body, least, most, most / least, kMaxContrast));
}

}  // namespace

MaterialField material_field(const SolidSpec& body, const TetMesh& mesh) {
  MaterialField field{{body.material}, {}, {}};
  if (body.materials.empty()) return field;
  field.of_element.assign(mesh.tetrahedra.size(), 0);
  for (std::size_t i = 0; i < body.materials.size(); ++i) {
    const std::string place = fmt::format("body '{}': [[body.material]] number {}", body.name, i + 1);
    const auto elements = select_elements(mesh, body.materials[i].where, place);
    if (elements.empty()) throw std::runtime_error(place + " selects no element of the mesh");
    field.materials.push_back(body.materials[i].material);
    for (int e : elements) field.of_element[e] = static_cast<std::uint16_t>(i + 1);
  }
  refuse_contrast(field, body.name);
  return field;
}

namespace {

/// Of the nodes that for_each_clique hands out together, one list after the other.
template <class ForEachClique>
NodeGraph graph_of(std::size_t n, ForEachClique&& for_each_clique) {
  std::vector<std::int64_t> begin(n + 1, 0);
  for_each_clique([&](const auto& clique) {
    for (int j : clique)
      for (int k : clique) begin[j + 1] += k >= j;
  });
  for (std::size_t i = 0; i < n; ++i) begin[i + 1] += begin[i];
  std::vector<int> pairs(begin[n]);
  auto next = begin;
  for_each_clique([&](const auto& clique) {
    for (int j : clique)
      for (int k : clique)
        if (k >= j) pairs[next[j]++] = k;
  });

  NodeGraph graph;
  graph.begin.assign(n + 1, 0);
  graph.neighbour.reserve(pairs.size() / 3);
  for (std::size_t i = 0; i < n; ++i) {
    const auto first = pairs.begin() + begin[i], last = pairs.begin() + begin[i + 1];
    std::sort(first, last);
    graph.neighbour.insert(graph.neighbour.end(), first, std::unique(first, last));
    graph.begin[i + 1] = static_cast<std::int64_t>(graph.neighbour.size());
  }
  return graph;
}

}  // namespace

NodeGraph node_graph(const TetMesh& mesh) {
  return graph_of(mesh.nodes.size(), [&](const auto& take) { std::ranges::for_each(mesh.tetrahedra, take); });
}

NodeGraph node_graph(const TetMesh& mesh, const MaterialField& materials) {
  if (materials.nodal_strain.empty()) return node_graph(mesh);
  const NodalPatches patches = patches_of(mesh, materials);
  return graph_of(mesh.nodes.size(), [&](const auto& take) {
    std::ranges::for_each(mesh.tetrahedra, take);
    for (int p = 0; p < patches.size(); ++p) take(patches.nodes(p));
  });
}

SparseMatrix lower_triangle(const std::vector<Eigen::Matrix3d>& blocks, const DofMap& dofs, const NodeGraph& graph) {
  SparseMatrix stiffness(dofs.size(), dofs.size());
  stiffness.reserve(static_cast<std::int64_t>(9 * blocks.size()));
  for (int column = 0; column < dofs.size(); ++column) {
    const int node = dofs.dof(column) / 3, axis = dofs.dof(column) % 3;
    stiffness.startVec(column);
    for (auto at = graph.begin[node]; at < graph.begin[node + 1]; ++at)
      for (int b = 0; b < 3; ++b) {
        const int row = dofs.index(graph.neighbour[at], b);
        if (row >= column) stiffness.insertBack(row, column) = blocks[at](b, axis);
      }
  }
  stiffness.finalize();
  return stiffness;
}

SparseMatrix assemble_stiffness(const TetMesh& mesh, const MaterialField& materials, const DofMap& dofs,
                                const NodeGraph& graph) {
  return lower_triangle(assemble_blocks(mesh, materials, graph), dofs, graph);
}

SparseMatrix assemble_stiffness(const TetMesh& mesh, const MaterialField& materials, const DofMap& dofs) {
  return assemble_stiffness(mesh, materials, dofs, node_graph(mesh, materials));
}

std::vector<Eigen::Vector3d> internal_force(const TetMesh& mesh, const MaterialField& materials,
                                            const std::vector<Eigen::Vector3d>& displacement) {
  std::vector<Eigen::Vector3d> force(mesh.nodes.size(), Eigen::Vector3d::Zero());
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    if (materials.averages(e)) continue;
    const auto& tet = mesh.tetrahedra[e];
    const auto gradients = gradients_of(mesh, tet);
    Eigen::Matrix<double, 4, 3> u;
    for (int j = 0; j < 4; ++j) u.row(j) = displacement[tet[j]];
    const auto stress = element_stress(gradients, lame(materials.at(static_cast<int>(e))), u);
    for (int j = 0; j < 4; ++j) force[tet[j]] += gradients.volume * stress * gradients.gradient.row(j).transpose();
  }
  if (!materials.nodal_strain.empty()) add_patch_forces(patches_of(mesh, materials), displacement, force);
  return force;
}

std::vector<Eigen::Matrix3d> element_stresses(const TetMesh& mesh, const MaterialField& materials,
                                              const std::vector<Eigen::Vector3d>& displacement) {
  std::vector<Eigen::Matrix3d> stress;
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    const auto& tet = mesh.tetrahedra[e];
    Eigen::Matrix<double, 4, 3> u;
    for (int v = 0; v < 4; ++v) u.row(v) = displacement[tet[v]].transpose();
    stress.push_back(element_stress(gradients_of(mesh, tet), lame(materials.at(static_cast<int>(e))), u));
  }
  return stress;
}

}  // namespace palpate

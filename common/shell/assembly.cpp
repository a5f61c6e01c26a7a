#include "common/shell/assembly.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <stdexcept>

#include "common/shell/shell_element.hpp"

namespace palpate {
namespace {

using Entry = Eigen::Triplet<double, std::int64_t>;

std::array<Eigen::Vector3d, 3> corners_of(const ShellMesh& mesh, const std::array<int, 3>& triangle) {
  return {mesh.nodes[triangle[0]], mesh.nodes[triangle[1]], mesh.nodes[triangle[2]]};
}

/// The free number of each of the element's 18 dofs, or a negative one.
std::array<int, 18> element_dofs(const std::array<int, 3>& triangle, const ShellDofs& dofs) {
  std::array<int, 18> index;
  for (int i = 0; i < 18; ++i) index[i] = dofs.index(triangle[i / 6], i % 6);
  return index;
}

void add_lower(const ShellStiffness& element, const std::array<int, 18>& index, std::vector<Entry>& entries) {
  for (int j = 0; j < 18; ++j)
    for (int i = 0; i < 18; ++i)
      if (index[j] >= 0 && index[i] >= index[j]) entries.emplace_back(index[i], index[j], element(i, j));
}

}  // namespace

SparseMatrix assemble_shell_stiffness(const ShellMesh& mesh, const ShellMaterial& material, Bending bending,
                                      const ShellDofs& dofs, const std::string& where) {
  std::vector<Entry> entries;
  entries.reserve(171 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    try {
      const auto element = shell_element_stiffness(corners_of(mesh, mesh.triangles[t]), material, bending);
      add_lower(element, element_dofs(mesh.triangles[t], dofs), entries);
    } catch (const std::runtime_error& reason) {
      throw std::runtime_error(fmt::format("{}: triangle {}: {}", where, t, reason.what()));
    }
  }
  SparseMatrix stiffness(dofs.size(), dofs.size());
  stiffness.setFromTriplets(entries.begin(), entries.end());
  return stiffness;
}

std::vector<double> lumped_shell_mass(const ShellMesh& mesh, const ShellMaterial& material) {
  std::vector<double> mass(mesh.nodes.size(), 0);
  for (const auto& triangle : mesh.triangles) {
    const auto [a, b, c] = corners_of(mesh, triangle);
    const double area = 0.5 * (b - a).cross(c - a).norm();
    for (int node : triangle) mass[node] += material.density * material.thickness * area / 3;
  }
  return mass;
}

std::vector<char> used_shell_nodes(const ShellMesh& mesh) {
  std::vector<char> used(mesh.nodes.size(), 0);
  for (const auto& triangle : mesh.triangles)
    for (int node : triangle) used[node] = 1;
  return used;
}

}  // namespace palpate

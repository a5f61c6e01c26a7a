#include "common/models/modal_shell/precompute.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <numbers>
#include <stdexcept>

#include "common/fem/body_loads.hpp"
#include "common/fem/dense.hpp"
#include "common/fem/factorisation.hpp"
#include "common/fem/stopwatch.hpp"
#include "common/mesh/shell_file.hpp"
#include "common/models/solid/precompute.hpp"
#include "common/shell/boundary_conditions.hpp"
#include "common/shell/modes.hpp"
#include "common/shell/shell_system.hpp"

namespace palpate {
namespace {

using Eigen::Index;

constexpr std::size_t kBlock = 64;  // right-hand sides at once

ShellMaterial material_of(const ShellSpec& body) {
  return {body.material.young, body.material.poisson, body.material.density, body.shell.thickness};
}

bool any_free(const ShellDofs& dofs, int node) {
  return dofs.index(node, 0) >= 0 || dofs.index(node, 1) >= 0 || dofs.index(node, 2) >= 0;
}

std::vector<char> touchable_mask(const ShellSpec& body, const ShellMesh& mesh, const ShellDofs& dofs) {
  std::vector<char> touchable(mesh.nodes.size(), !body.touchable);
  const std::string place = fmt::format("body '{}': [body.touchable]", body.name);
  if (body.touchable)
    for (int node : select_nodes(mesh, *body.touchable, place)) touchable[node] = 1;
  for (int node = 0; node < dofs.nodes(); ++node) touchable[node] &= any_free(dofs, node);
  if (std::find(touchable.begin(), touchable.end(), 1) == touchable.end())
    throw std::runtime_error(place + " selects no free node of the surface");
  return touchable;
}

/// Numbers of the surface's dofs among the free translations.
std::vector<Index> numbers_of(const SurfaceMap& surface, const std::vector<Dof>& surface_dofs, const ShellDofs& dofs) {
  std::vector<Index> numbers;
  for (const Dof& dof : surface_dofs) numbers.push_back(dofs.index(surface.node_number[dof.node], dof.axis));
  return numbers;
}

/// How its loads and its weight move the wall.
std::vector<Eigen::Vector3d> sag_of(const ShellSpec& body, const ShellMesh& mesh, const ShellSystem& system,
                                    const SurfaceMap& surface) {
  const StaticLoads loads = shell_loads(body, mesh);
  if (loads.empty() && body.gravity.isZero(0)) return {};
  const auto force = force_vector(loads, mesh.nodes);
  const auto mass = lumped_shell_mass(mesh, material_of(body));
  Eigen::VectorXd load = Eigen::VectorXd::Zero(system.stiffness.rows());
  for (int node = 0; node < system.dofs.nodes(); ++node)
    for (int axis = 0; axis < 3; ++axis)
      if (const int at = system.dofs.index(node, axis); at >= 0)
        load[at] = force[node][axis] + mass[node] * body.gravity[axis];

  Factorisation factor(system.stiffness);
  factor.factorise(system.stiffness);
  const Eigen::VectorXd u = factor.solve(load);
  std::vector<Eigen::Vector3d> sag(surface.position.size(), Eigen::Vector3d::Zero());
  for (std::size_t n = 0; n < sag.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (const int at = system.dofs.index(surface.node_number[n], axis); at >= 0) sag[n][axis] = u[at];
  return sag;
}

/// Columns of K^-1 without moments, a block at a time: few entries of a shell's factor stand against many
/// right-hand sides, so that this is cheaper than condensing onto the translations.
void add_compliance(const SparseMatrix& stiffness, const ShellDofs& dofs, Archive& archive) {
  const auto touchable = numbers_of(archive.surface, archive.touchable_dofs, dofs);
  const auto other = numbers_of(archive.surface, archive.other_dofs, dofs);
  const std::size_t t = touchable.size(), o = other.size();
  archive.touchable_compliance.resize(t * (t + 1) / 2);
  archive.other_compliance.resize(o * t);
  Factorisation factor(stiffness);
  factor.factorise(stiffness);
  for (std::size_t begin = 0; begin < t; begin += kBlock) {
    const std::size_t count = std::min(kBlock, t - begin);
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(stiffness.rows(), static_cast<Index>(count));
    for (std::size_t c = 0; c < count; ++c) unit(touchable[begin + c], c) = 1;
    const Eigen::MatrixXd column = factor.solve(unit);
    for (std::size_t i = begin; i < t; ++i)
      for (std::size_t c = 0; c < count && begin + c <= i; ++c)
        archive.touchable_compliance[i * (i + 1) / 2 + begin + c] = column(touchable[i], c);
    for (std::size_t i = 0; i < o; ++i)
      for (std::size_t c = 0; c < count; ++c) archive.other_compliance[i * t + begin + c] = column(other[i], c);
  }
}

void add_modes(const ShellSpec& body, const ShellSystem& system, const std::vector<double>& node_mass,
               Archive& archive) {
  const auto modes = lowest_modes(system.stiffness, system.mass, body.shell.modes);
  ModalTensors& modal = archive.modal.emplace();
  modal.thickness = body.shell.thickness;
  modal.omega.assign(modes.omega.begin(), modes.omega.end());
  for (int node : archive.surface.node_number) modal.mass.push_back(node_mass[node]);
  const std::size_t rows = 3 * archive.surface.position.size();
  modal.shape.assign(rows * modal.omega.size(), 0);
  for (int node = 0; node < archive.surface.size(); ++node)
    for (int axis = 0; axis < 3; ++axis) {
      const int free = system.dofs.index(archive.surface.node_number[node], axis);
      if (free < 0) continue;
      for (int m = 0; m < modal.modes(); ++m) modal.shape[rows * m + 3 * node + axis] = modes.shape(free, m);
    }
}

}  // namespace

SurfaceMap make_surface_map(const ShellSpec& body, const ShellMesh& mesh, const ShellDofs& dofs) {
  const auto touchable = touchable_mask(body, mesh, dofs);
  SurfaceMap map;
  std::vector<int> index(mesh.nodes.size(), -1);
  const auto append = [&](int node) {
    index[node] = map.size();
    map.position.push_back(mesh.nodes[node]);
    map.node_number.push_back(node);
    map.fixed.push_back({dofs.index(node, 0) < 0, dofs.index(node, 1) < 0, dofs.index(node, 2) < 0});
  };
  for (int node = 0; node < dofs.nodes(); ++node)
    if (touchable[node]) append(node);
  map.touchable = map.size();
  for (int node = 0; node < dofs.nodes(); ++node)
    if (!touchable[node] && dofs.index(node, 0) != ShellDofs::kUnused) append(node);
  for (const auto& t : mesh.triangles) map.triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
  return map;
}

StaticLoads shell_loads(const ShellSpec& body, const ShellMesh& mesh) {
  return body_loads(body, mesh.triangles,
                    [&](const Selector& where, const std::string& place) { return select_nodes(mesh, where, place); });
}

ShellSystem shell_system(const ModalShellSpec& body, const ShellMesh& mesh, const std::string& where) {
  auto dofs = apply_boundary_conditions(mesh, body, where);
  check_shell(body, mesh, dofs, where);
  return make_shell_system(mesh, material_of(body), body.shell.bending, std::move(dofs), where);
}

Archive precompute(const ModalShellSpec& body, const ShellMesh& mesh, const Progress& progress) try {
  const std::string where = fmt::format("body '{}'", body.name);
  Stopwatch watch(progress);
  const ShellSystem system = shell_system(body, mesh, where);
  watch.lap("assembly");
  Archive archive;
  archive.body = body.name;
  archive.model = ModalShellSpec::kKind;
  archive.parts.modal = true;
  archive.software = fmt::format("palpate {}, OpenBLAS for {}", PALPATE_VERSION, blas_kernels());
  archive.mesh_nodes = static_cast<int>(mesh.nodes.size());
  archive.young = {body.material.young};
  archive.poisson = {body.material.poisson};
  archive.density = {body.material.density};
  archive.surface = make_surface_map(body, mesh, system.dofs);
  archive.touchable_dofs = free_dofs(archive.surface, 0, archive.surface.touchable);
  archive.other_dofs = free_dofs(archive.surface, archive.surface.touchable, archive.surface.size());
  archive.sag = sag_of(body, mesh, system, archive.surface);
  watch.lap("surface");

  add_modes(body, system, lumped_shell_mass(mesh, material_of(body)), archive);
  watch.lap(fmt::format("{} modes", body.shell.modes));
  add_compliance(system.stiffness, system.dofs, archive);
  watch.lap("compliance");
  return archive;
} catch (const std::bad_alloc&) {
  throw std::runtime_error(fmt::format("body '{}': not enough memory for its tensors", body.name));
}

std::vector<std::string> archive_lines(const ModalShellSpec&, const Archive& archive) {
  const auto& omega = archive.modal->omega;
  return {fmt::format("{} modes of {:.4g} to {:.4g} Hz", omega.size(), omega.front() / (2 * std::numbers::pi),
                      omega.back() / (2 * std::numbers::pi))};
}

ArchiveJob archive_job(const ModalShellSpec& body, const Progress& progress) {
  return [&, mesh = load_shell_mesh(body.mesh, body.scale)] { return precompute(body, mesh, progress); };
}

}  // namespace palpate

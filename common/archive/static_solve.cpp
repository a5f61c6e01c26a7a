#include "common/archive/static_solve.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <stdexcept>

#include "common/archive/compressed_compliance.hpp"
#include "common/geometry/dense_solvers.hpp"

namespace palpate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Finds rows of the compliance by mesh node.
class RowFinder {
 public:
  explicit RowFinder(const Archive& archive) : archive_(archive), row_(3 * archive.surface.size(), -1) {
    for (std::size_t i = 0; i < archive.touchable_dofs.size(); ++i)
      row_[3 * archive.touchable_dofs[i].node + archive.touchable_dofs[i].axis] = static_cast<int>(i);
    for (int i = 0; i < archive.surface.size(); ++i) surface_[archive.surface.node_number[i]] = i;
  }

  /// Row of C_tt, or -1 on a fixed axis.
  int operator()(int node, int axis) const {
    const auto found = surface_.find(node);
    if (found == surface_.end()) throw std::runtime_error(fmt::format("node {} is not on the surface", node));
    const bool fixed = archive_.surface.fixed[found->second][axis];
    if (!fixed && found->second >= archive_.surface.touchable)
      throw std::runtime_error(fmt::format("node {} is not touchable", node));
    return fixed ? -1 : row_[3 * found->second + axis];
  }

 private:
  const Archive& archive_;
  std::vector<int> row_;
  std::map<int, int> surface_;
};

double entry(const CompressedCompliance& compliance, const Dof& moved, const Dof& loaded) {
  return compliance.block(moved.node, loaded.node)(moved.axis, loaded.axis);
}

double touchable_entry(const Archive& archive, std::size_t i, std::size_t j) {
  if (archive.compressed) return entry(*archive.compressed, archive.touchable_dofs[i], archive.touchable_dofs[j]);
  if (i < j) std::swap(i, j);
  return archive.touchable_compliance[i * (i + 1) / 2 + j];
}

double other_entry(const Archive& archive, std::size_t i, std::size_t j) {
  if (archive.compressed) return entry(*archive.compressed, archive.other_dofs[i], archive.touchable_dofs[j]);
  return archive.other_compliance[i * archive.touchable_dofs.size() + j];
}

/// A touchable dof with a coefficient: a weight of a condition, or a force.
struct Entry {
  int row;
  double value;
};

/// One sparse row of J over the touchable dofs; fixed axes do not move and drop out.
std::vector<Entry> row_of(const Constraint& constraint, const RowFinder& find) {
  std::vector<Entry> row;
  for (const auto& [node, axis, weight] : constraint.terms)
    if (const int place = find(node, axis); place >= 0) row.push_back({place, weight});
  if (row.empty()) {
    const auto& term = constraint.terms.at(0);
    throw std::runtime_error(fmt::format("node {} cannot be held along {}: it is fixed", term.node, "xyz"[term.axis]));
  }
  return row;
}

/// u = C f over the whole visible surface.
SurfaceSolution respond(const Archive& archive, const std::vector<Entry>& forces) {
  const auto nodes = static_cast<std::size_t>(archive.surface.size());
  SurfaceSolution solution{std::vector<Vector3d>(nodes, Vector3d::Zero()),
                           std::vector<Vector3d>(nodes, Vector3d::Zero())};
  const std::size_t columns = archive.touchable_dofs.size();
  for (const auto& [row, force] : forces) {
    const auto& dof = archive.touchable_dofs[row];
    solution.force[dof.node][dof.axis] += force;
    for (std::size_t i = 0; i < columns; ++i)
      solution.displacement[archive.touchable_dofs[i].node][archive.touchable_dofs[i].axis] +=
          touchable_entry(archive, i, row) * force;
    for (std::size_t i = 0; i < archive.other_dofs.size(); ++i)
      solution.displacement[archive.other_dofs[i].node][archive.other_dofs[i].axis] +=
          other_entry(archive, i, row) * force;
  }
  return solution;
}

void check_complete(const Archive& archive) {
  if (!archive.tetrahedra.empty())
    throw std::runtime_error(fmt::format(
        "body '{}' moves with inertia: its archive holds no compliance of the whole surface", archive.body));
  const std::size_t t = archive.touchable_dofs.size();
  const bool complete = archive.compressed ? archive.compressed->has_others() || archive.other_dofs.empty()
                                           : archive.touchable_compliance.size() == t * (t + 1) / 2 &&
                                                 archive.other_compliance.size() == archive.other_dofs.size() * t;
  if (!complete) throw std::runtime_error("the archive was read without the compliance of the whole surface");
}

/// The held dofs of each held node.
struct HeldNodes {
  std::vector<int> row;      // of C_tt, node by node
  VectorXd value;            // u*
  std::vector<Index> begin;  // first dof of each node, and the end
};

HeldNodes group_by_node(const Archive& archive, const std::vector<Constraint>& holds) {
  const RowFinder find(archive);
  std::map<std::pair<int, int>, std::pair<int, double>> sorted;
  for (const auto& constraint : holds) {
    if (constraint.terms.size() != 1) throw std::runtime_error("the paper's superposition holds nodes, not points");
    const auto& term = constraint.terms[0];
    sorted[{term.node, term.axis}] = {row_of(constraint, find)[0].row, constraint.value / term.weight};
  }
  HeldNodes held;
  held.value.resize(static_cast<Index>(sorted.size()));
  int last = -1;
  for (const auto& [place, hold] : sorted) {
    const auto at = static_cast<Index>(held.row.size());
    if (place.first != last) held.begin.push_back(at);
    last = place.first;
    held.row.push_back(hold.first);
    held.value[at] = hold.second;
  }
  held.begin.push_back(static_cast<Index>(held.row.size()));
  return held;
}

MatrixXd block(const Archive& archive, const std::vector<int>& rows, const std::vector<int>& columns) {
  MatrixXd result(rows.size(), columns.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < columns.size(); ++j) result(i, j) = touchable_entry(archive, rows[i], columns[j]);
  return result;
}

}  // namespace

SurfaceSolution solve_tensors(const Archive& archive, const std::vector<Constraint>& constraints,
                              const std::vector<NodalLoad>& loads) {
  check_complete(archive);
  const RowFinder find(archive);
  const auto count = static_cast<Index>(constraints.size());
  std::vector<Entry> forces;
  for (const auto& [node, force] : loads)
    for (int axis = 0; axis < 3; ++axis)
      if (const int row = find(node, axis); row >= 0) forces.push_back({row, force[axis]});
  std::vector<std::vector<Entry>> rows;
  VectorXd value(count);
  for (Index c = 0; c < count; ++c) {
    rows.push_back(row_of(constraints[c], find));
    value[c] = constraints[c].value;
    for (const auto& left : rows.back())
      for (const auto& right : forces)
        value[c] -= left.value * touchable_entry(archive, left.row, right.row) * right.value;
  }
  MatrixXd compliance = MatrixXd::Zero(count, count);  // J C J^T
  for (Index a = 0; a < count; ++a)
    for (Index b = 0; b <= a; ++b) {
      for (const auto& left : rows[a])
        for (const auto& right : rows[b])
          compliance(a, b) += left.value * touchable_entry(archive, left.row, right.row) * right.value;
      compliance(b, a) = compliance(a, b);
    }
  const DenseCholesky factor(compliance);
  if (count > 0 && !factor.well_conditioned())
    throw std::runtime_error("the held points repeat or contradict one another");
  const VectorXd multiplier = factor.solve(value);
  for (Index c = 0; c < count; ++c)
    for (const auto& [row, weight] : rows[c]) forces.push_back({row, weight * multiplier[c]});
  return respond(archive, forces);
}

SurfaceSolution superpose_tensors(const Archive& archive, const std::vector<Constraint>& holds, Superposition how) {
  check_complete(archive);
  const auto held = group_by_node(archive, holds);
  const auto size = held.value.size();
  // T^f_k = C_kk^-1 (sec. 4-1), block diagonal over the held nodes.
  MatrixXd force_tensor = MatrixXd::Zero(size, size);
  for (std::size_t k = 0; k + 1 < held.begin.size(); ++k) {
    const std::vector<int> own(held.row.begin() + held.begin[k], held.row.begin() + held.begin[k + 1]);
    const auto extent = static_cast<Index>(own.size());
    force_tensor.block(held.begin[k], held.begin[k], extent, extent) = invert_general(block(archive, own, own));
  }
  VectorXd displacement = held.value;  // u~
  if (how == Superposition::corrected) {
    const MatrixXd m = block(archive, held.row, held.row) * force_tensor;  // T^u_lk = C_lk C_kk^-1
    displacement = solve_general(m, held.value);                           // eq. 8
  }
  const VectorXd force = force_tensor * displacement;  // eq. 10
  std::vector<Entry> forces;
  for (Index i = 0; i < size; ++i) forces.push_back({held.row[i], force[i]});
  return respond(archive, forces);  // eq. 9: T^u_nk u~_k = C_nk f_k
}

void require_numbers(const std::vector<int>& node, const std::vector<Eigen::Vector3d>& displacement,
                     const std::vector<Eigen::Vector3d>& force) {
  for (std::size_t i = 0; i < node.size(); ++i)
    if (!std::isfinite(displacement[i].norm()) || !std::isfinite(force[i].norm()))
      throw std::runtime_error(fmt::format("there is no solution in numbers: at node {} it is not finite", node[i]));
}

}  // namespace palpate

#include <algorithm>

#include "common/dynamics/condensed_part.hpp"
#include "common/kernels/kernels.hpp"

/// Contacts of a CondensedPart, condensed on its connection nodes.
namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector = Eigen::Map<Eigen::VectorXd>;
using ConstVector = Eigen::Map<const Eigen::VectorXd>;

constexpr std::ptrdiff_t kStride = kernels::leading_dimension(3 * CondensedPart::kMaxContacts);

}  // namespace

/// Where an anchor would be with the connection nodes at rest and nothing touching.
Vector3d CondensedPart::still_position(const Anchor& anchor) const {
  Vector3d position = Vector3d::Zero();
  for (int v = 0; v < 3; ++v) {
    const int node = anchor.nodes[v];
    if (anchor.weights[v] != 0)
      position += anchor.weights[v] * (rest_[node] + sag_[node] + respond(node, dead_) + pushed(node));
  }
  return position;
}

void CondensedPart::count_shares() {
  std::fill(shares_.begin(), shares_.end(), 0);
  for (const TouchContact& contact : law_.contacts())
    for (int v = 0; v < 3 && contact.touch != Touch::open; ++v)
      if (contact.anchor.weights[v] != 0 && place_[contact.anchor.nodes[v]] >= 0)
        ++shares_[place_[contact.anchor.nodes[v]]];
}

/// Compliance [m/N] that a contact gets where it rests on connection nodes. These have no compliance of their
/// own but mass: with s_p = sum w^2 n/m over the connection nodes of point p (n: how many contacts share the
/// node), all the contacts' stiffnesses a/s_p together add at most a = contact_bound_ to the square of any
/// frequency, by Cauchy's inequality.
double CondensedPart::softness(const TouchContact& contact) const {
  double sum = 0;
  for (int v = 0; v < 3; ++v) {
    const int k = place_[contact.anchor.nodes[v]];
    const double w = contact.anchor.weights[v];
    if (w != 0 && k >= 0) sum += w * w * shares_[k] / mass_[k];
  }
  return sum / contact_bound_;
}

void CondensedPart::list_rows() {
  rows_.clear();
  row_begin_.assign(1, 0);
  const auto contacts = law_.contacts();
  for (int c = 0; c < static_cast<int>(contacts.size()); ++c) {
    const TouchContact& contact = contacts[c];
    friction_force_[c].setZero();
    if (contact.touch == Touch::sliding) {
      friction_force_[c] = friction_ * std::max(0.0, contact.force.dot(contact.normal)) * contact.slip;
      rows_.push_back({c, contact.normal});
    } else if (contact.touch != Touch::open) {
      for (int axis = 0; axis < 3; ++axis) rows_.push_back({c, Vector3d::Unit(axis)});
    }
    row_begin_.push_back(static_cast<int>(rows_.size()));
  }
}

/// A row of J H, connection nodes of the anchor included.
void CondensedPart::fill_row(int r) {
  Vector out(held_.data() + static_cast<std::size_t>(size_) * r, size_);
  out.setZero();
  const Anchor& anchor = law_.contacts()[rows_[r].contact].anchor;
  for (int v = 0; v < 3; ++v) {
    const int node = anchor.nodes[v];
    const Vector3d along = anchor.weights[v] * rows_[r].axis;
    if (place_[node] >= 0) out.segment<3>(3 * place_[node]) += along;
    if (row_[node] < 0) continue;
    for (int axis = 0; axis < 3; ++axis)
      if (along[axis] != 0) out += along[axis] * ConstVector(follow(node, axis).data(), size_);
  }
}

/// The Cholesky factor of R (J C J^T + softness) R^T, and in constant_ the displacements R (d - J x_0) that
/// the held rows ask for, less what friction makes of them.
void CondensedPart::factorise() {
  const auto contacts = law_.contacts();
  const int count = static_cast<int>(rows_.size());
  for (int r = 0; r < count; ++r) {
    const auto& [cr, axis] = rows_[r];
    const TouchContact& contact = contacts[cr];
    const Vector3d still = still_position(contact.anchor);
    constant_[r] = contact.touch == Touch::sliding ? contact.plane - axis.dot(still) : axis.dot(contact.target - still);
  }
  for (std::size_t a = 0; a < contacts.size(); ++a)
    for (std::size_t b = 0; b < contacts.size(); ++b) {
      if (row_begin_[a] == row_begin_[a + 1] || contacts[b].touch == Touch::open) continue;
      Matrix3d block = compliance(contacts[a].anchor, contacts[b].anchor);
      if (a == b) block += softness(contacts[a]) * Matrix3d::Identity();
      for (int r = row_begin_[a]; r < row_begin_[a + 1]; ++r) {
        for (int s = row_begin_[b]; s < row_begin_[b + 1]; ++s)
          factor_[kStride * s + r] = rows_[r].axis.dot(block * rows_[s].axis);
        constant_[r] -= rows_[r].axis.dot(block * friction_force_[b]);
      }
    }
  for (int r = 0; r < count; ++r) floor_[r] = HeldPoints::kPivotShare * std::max(factor_[kStride * r + r], typical_);
  kernels::active().cholesky(factor_.data(), count, kStride, floor_.data());
}

/// load_ += H^T J^T f, connection nodes of the anchor included.
void CondensedPart::add_follow_force(const Anchor& anchor, const Vector3d& force) {
  for (int v = 0; v < 3; ++v)
    if (anchor.weights[v] != 0) add_follow_force(anchor.nodes[v], anchor.weights[v] * force, load_);
}

/// The same of a node, to the forces on the connection nodes.
void CondensedPart::add_follow_force(int node, const Vector3d& force, std::span<double> to) const {
  Vector load(to.data(), size_);
  if (place_[node] >= 0) load.segment<3>(3 * place_[node]) += force;
  if (row_[node] < 0) return;
  for (int axis = 0; axis < 3; ++axis) load += force[axis] * ConstVector(follow(node, axis).data(), size_);
}

void CondensedPart::condense() {
  count_shares();
  list_rows();
  const int count = static_cast<int>(rows_.size());
  for (int r = 0; r < count; ++r) fill_row(r);
  factorise();
  kernels::active().cholesky_solve(factor_.data(), count, kStride, constant_.data());

  load_ = reaction_;
  for (const auto& [node, force] : dead_) add_follow_force({{node, node, node}, Vector3d::UnitX()}, force);
  const auto contacts = law_.contacts();
  for (std::size_t c = 0; c < contacts.size(); ++c)
    if (!friction_force_[c].isZero(0)) add_follow_force(contacts[c].anchor, friction_force_[c]);
  for (int r = 0; r < count; ++r) Vector(load_.data(), size_) += constant_[r] * ConstVector(held_rows_[r], size_);
}

void CondensedPart::apply(const double* u, double* force) {
  if (size_ == 0) return;
  Vector out(force, size_);
  if (single_) {
    for (int i = 0; i < size_; ++i) u_f_[i] = static_cast<float>(u[i]);
    kernels::active().combine_f(stiffness_columns_f_.data(), u_f_.data(), size_, size_, product_f_.data());
    for (int i = 0; i < size_; ++i) force[i] -= product_f_[i];
  } else {
    kernels::active().combine_d(stiffness_columns_d_.data(), u, size_, size_, product_.data());
    out -= ConstVector(product_.data(), size_);
  }
  const int count = static_cast<int>(rows_.size());
  if (count == 0) return;
  for (int r = 0; r < count; ++r) multiplier_[r] = ConstVector(held_rows_[r], size_).dot(ConstVector(u, size_));
  kernels::active().cholesky_solve(factor_.data(), count, kStride, multiplier_.data());
  kernels::active().combine_d(held_rows_.data(), multiplier_.data(), count, size_, product_.data());
  out -= ConstVector(product_.data(), size_);
}

/// Forces of the contacts at the present displacements of the connection nodes, and all forces on touchable
/// nodes.
void CondensedPart::find_forces() {
  const auto contacts = law_.contacts();
  const int count = static_cast<int>(rows_.size());
  for (int r = 0; r < count; ++r) multiplier_[r] = ConstVector(held_rows_[r], size_).dot(ConstVector(u_.data(), size_));
  kernels::active().cholesky_solve(factor_.data(), count, kStride, multiplier_.data());
  for (std::size_t c = 0; c < contacts.size(); ++c) contact_force_[c] = friction_force_[c];
  for (int r = 0; r < count; ++r) contact_force_[rows_[r].contact] += (constant_[r] - multiplier_[r]) * rows_[r].axis;
  list_node_forces();
}

void CondensedPart::adopt(const DynamicModel& model, std::span<const Vector3d> forces) {
  rows_.clear();
  take(model);
  std::copy(forces.begin(), forces.end(), contact_force_.begin());
  list_node_forces();
}

/// What contacts and dead forces come to at the nodes of this part.
void CondensedPart::list_node_forces() {
  const auto contacts = law_.contacts();
  node_forces_.assign(dead_.begin(), dead_.end());
  for (std::size_t c = 0; c < contacts.size(); ++c)
    for (int v = 0; v < 3; ++v) {
      const int node = contacts[c].anchor.nodes[v];
      const double w = contacts[c].anchor.weights[v];
      if (w != 0 && row_[node] >= 0 && node < compliance_.column_nodes() && contacts[c].touch != Touch::open)
        node_forces_.push_back({node, w * contact_force_[c]});
    }
}

void CondensedPart::add_loads(DynamicModel& model) {
  for (std::size_t k = 0; k < connection_.size(); ++k) {
    const Vector3d before = Eigen::Map<const Vector3d>(added_.data() + 3 * k);
    model.set_load(connection_[k], model.load(connection_[k]) - before + load(static_cast<int>(k)));
  }
  added_ = load_;
}

}  // namespace palpate

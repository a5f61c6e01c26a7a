#include "common/dynamics/condensed_part.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/geometry/principal_axes.hpp"
#include "common/kernels/kernels.hpp"

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using ConstVector = Eigen::Map<const Eigen::VectorXd>;

constexpr int kRows = 3 * CondensedPart::kMaxContacts;

double dot(const double* a, const double* b, int size) {
  return ConstVector(a, size).dot(ConstVector(b, size));
}

int padded(int size) {
  return (size + 15) / 16 * 16;
}

const Archive& checked(const Archive& archive) {
  if (!archive.condensed) throw std::runtime_error("body '" + archive.body + "' has no condensed part");
  const std::size_t c = archive.condensed->dofs.size();
  if (archive.condensed->stiffness.size() != c * (c + 1) / 2)
    throw std::runtime_error("the archive of body '" + archive.body + "' was read without its condensed part");
  return archive;
}

double mean_diagonal(const Archive& archive) {
  double sum = 0;
  const std::size_t count = archive.touchable_dofs.size();
  for (std::size_t i = 0; i < count; ++i) sum += archive.touchable_compliance[i * (i + 1) / 2 + i];
  return count ? sum / static_cast<double>(count) : 1;
}

}  // namespace

CondensedPart::CondensedPart(const Archive& archive, double friction, bool single)
    : rest_(checked(archive).surface.position),
      connection_(archive.condensed->connection),
      place_(rest_.size(), -1),
      mass_(archive.condensed->mass),
      bound_(archive.condensed->bound),
      contact_bound_(bound_),
      friction_(friction),
      typical_(mean_diagonal(archive)),
      size_(3 * static_cast<int>(connection_.size())),
      single_(single),
      row_(rest_.size(), -1),
      reaction_(size_, 0.0),
      sag_(rest_.size(), Vector3d::Zero()),
      gap_(archive.condensed->gap),
      compliance_(archive, Compliance<double>::Rows::touchable),
      picture_(archive, Compliance<float>::Rows::surface),
      free_(rest_),
      position_(rest_),
      response_(compliance_),
      law_({response_, free_}, ContactLaw::Rule::barycentric, friction, kMaxContacts),
      factor_(kernels::leading_dimension(kRows) * kRows, 0.0),
      floor_(kRows, 0.0),
      held_(static_cast<std::size_t>(size_) * kRows, 0.0),
      product_(padded(size_), 0.0),
      multiplier_(kernels::leading_dimension(kRows), 0.0),
      constant_(kernels::leading_dimension(kRows), 0.0),
      shares_(connection_.size(), 0),
      friction_force_(kMaxContacts, Vector3d::Zero()),
      contact_force_(kMaxContacts, Vector3d::Zero()),
      u_(size_, 0.0),
      added_(size_, 0.0),
      u_f_(size_, 0.0f),
      product_f_(padded(size_), 0.0f) {
  for (std::size_t k = 0; k < connection_.size(); ++k) place_[connection_[k]] = static_cast<int>(k);
  fill_stiffness(*archive.condensed);
  fill_follow(archive);
  load_ = reaction_;
  rows_.reserve(kRows);
  row_begin_.reserve(kMaxContacts + 1);
  for (int r = 0; r < kRows; ++r) held_rows_.push_back(held_.data() + static_cast<std::size_t>(size_) * r);
  dead_.reserve(archive.surface.touchable);
  node_forces_.reserve(dead_.capacity() + 3 * kMaxContacts);
  const std::size_t columns = size_ + 3 * node_forces_.capacity();
  columns_.reserve(columns);
  coefficients_.reserve(columns);
}

/// Rows and columns of fixed axes are zero, so that connection node k is always entries 3 k .. 3 k + 2.
void CondensedPart::fill_stiffness(const CondensedTensors& condensed) {
  const int stride = padded(size_);
  if (single_) stiffness_f_.assign(static_cast<std::size_t>(stride) * size_, 0);
  if (!single_) stiffness_d_.assign(static_cast<std::size_t>(stride) * size_, 0);
  const auto entry = [&](const Dof& dof) { return static_cast<std::size_t>(3) * place_[dof.node] + dof.axis; };
  for (std::size_t i = 0; i < condensed.dofs.size(); ++i) {
    reaction_[entry(condensed.dofs[i])] = condensed.reaction[i];
    for (std::size_t j = 0; j <= i; ++j) {
      const double value = condensed.stiffness[i * (i + 1) / 2 + j];
      const std::size_t r = entry(condensed.dofs[i]), c = entry(condensed.dofs[j]);
      if (single_) stiffness_f_[stride * r + c] = stiffness_f_[stride * c + r] = static_cast<float>(value);
      if (!single_) stiffness_d_[stride * r + c] = stiffness_d_[stride * c + r] = value;
    }
  }
  for (int c = 0; c < size_; ++c) {
    if (single_) stiffness_columns_f_.push_back(stiffness_f_.data() + static_cast<std::size_t>(stride) * c);
    if (!single_) stiffness_columns_d_.push_back(stiffness_d_.data() + static_cast<std::size_t>(stride) * c);
  }
}

void CondensedPart::fill_follow(const Archive& archive) {
  auto dofs = archive.touchable_dofs;
  dofs.insert(dofs.end(), archive.other_dofs.begin(), archive.other_dofs.end());
  const CondensedTensors& condensed = *archive.condensed;
  int rows = 0;
  for (const Dof& dof : dofs)
    if (row_[dof.node] < 0) row_[dof.node] = 3 * rows++;
  follow_.assign(static_cast<std::size_t>(size_) * 3 * rows, 0.0);
  const std::size_t stride = padded(3 * static_cast<int>(rest_.size())), columns = condensed.dofs.size();
  follow_f_.assign(stride * size_, 0.0f);
  whole_.assign(stride, 0.0f);
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const auto& [node, axis] = dofs[i];
    sag_[node][axis] = condensed.sag[i];
    for (std::size_t j = 0; j < columns; ++j) {
      const int c = 3 * place_[condensed.dofs[j].node] + condensed.dofs[j].axis;
      const double value = condensed.follow[i * columns + j];
      follow_[static_cast<std::size_t>(size_) * (row_[node] + axis) + c] = value;
      follow_f_[stride * c + 3 * node + axis] = static_cast<float>(value);
    }
  }
  for (int c = 0; c < size_; ++c) follow_columns_f_.push_back(follow_f_.data() + stride * c);
}

void CondensedPart::couple(DynamicModel& model) {
  const double own = model.frequency_bound();
  contact_bound_ = std::max(own * own - bound_, bound_);
  model.couple(this, connection_, mass_, bound_ + contact_bound_);
}

void CondensedPart::set_force(int node, const Vector3d& force) {
  if (!owns(node) || node >= compliance_.column_nodes())
    throw std::runtime_error("a dead force acts on a node that is not touchable or not of the quasi-static part");
  const auto found = std::find_if(dead_.begin(), dead_.end(), [&](const NodeForce& f) { return f.node == node; });
  if (found != dead_.end())
    found->force = force;
  else
    dead_.push_back({node, force});
}

void CondensedPart::take(const DynamicModel& model) {
  for (std::size_t k = 0; k < connection_.size(); ++k)
    Eigen::Map<Vector3d>(u_.data() + 3 * k) = model.displacement(connection_[k]);
  find_forces();
}

Matrix3d CondensedPart::compliance(int i, int j) const {
  Matrix3d block = Matrix3d::Zero();
  if (i >= compliance_.row_nodes() || j >= compliance_.column_nodes()) return block;
  for (int c = 0; c < 3; ++c) block.col(c) = Eigen::Map<const Vector3d>(compliance_.column(j, c) + 3 * i);
  return block;
}

Matrix3d CondensedPart::compliance(const Anchor& a, const Anchor& b) const {
  Matrix3d sum = Matrix3d::Zero();
  for (int v = 0; v < 3; ++v)
    for (int w = 0; w < 3; ++w)
      if (a.weights[v] != 0 && b.weights[w] != 0)
        sum += a.weights[v] * b.weights[w] * compliance(a.nodes[v], b.nodes[w]);
  return sum;
}

/// Displacement of a node under forces on touchable nodes, the connection nodes standing still.
Vector3d CondensedPart::respond(int node, std::span<const NodeForce> forces) const {
  Vector3d u = Vector3d::Zero();
  for (const auto& [at, force] : forces)
    if (node < compliance_.row_nodes())
      u += compliance(node, at) * force;
    else if (at < picture_.column_nodes())
      for (int c = 0; c < 3; ++c)
        u += force[c] * Eigen::Map<const Eigen::Vector3f>(picture_.column(at, c) + 3 * node).cast<double>();
  return u;
}

/// What the connection nodes alone make of a node.
Vector3d CondensedPart::followed(int node) const {
  if (place_[node] >= 0) return Eigen::Map<const Vector3d>(u_.data() + 3 * place_[node]);
  if (row_[node] < 0) return Vector3d::Zero();
  Vector3d u = sag_[node];
  for (int axis = 0; axis < 3; ++axis) u[axis] += dot(follow(node, axis).data(), u_.data(), size_);
  return u;
}

Vector3d CondensedPart::displacement(int node) const {
  return followed(node) + respond(node, node_forces_) + pushed(node);
}

void CondensedPart::update(std::span<const int> nodes) {
  for (int node : nodes) {
    const Vector3d u = followed(node) + pushed(node);
    free_[node] = rest_[node] + u + respond(node, dead_);
    position_[node] = rest_[node] + u + respond(node, node_forces_);
  }
}

LawOutcome CondensedPart::hold() {
  for (const TouchContact& contact : law_.contacts()) update(contact.anchor.nodes);
  const LawOutcome outcome = law_.solve();
  condense();
  find_forces();
  return outcome;
}

void CondensedPart::superpose(std::span<Eigen::Vector3f> displacement) {
  columns_.assign(follow_columns_f_.begin(), follow_columns_f_.end());
  coefficients_.assign(u_.begin(), u_.end());
  const auto add = [&](std::span<const NodeForce> forces) {
    for (const auto& [node, force] : forces)
      for (int axis = 0; axis < 3 && node < picture_.column_nodes(); ++axis) {
        columns_.push_back(picture_.column(node, axis));
        coefficients_.push_back(static_cast<float>(force[axis]));
      }
  };
  add(node_forces_);
  for (const auto& forces : pushed_) add(forces);
  const int nodes = picture_.row_nodes();
  kernels::active().combine_f(columns_.data(), coefficients_.data(), static_cast<int>(columns_.size()), 3 * nodes,
                              whole_.data());
  for (int node = 0; node < nodes; ++node)
    if (row_[node] >= 0)
      displacement[node] = Eigen::Map<const Eigen::Vector3f>(whole_.data() + 3 * node) + sag_[node].cast<float>();
  for (std::size_t k = 0; k < connection_.size(); ++k)
    displacement[connection_[k]] = Eigen::Map<const Vector3d>(u_.data() + 3 * k).cast<float>();
}

Matrix3d CondensedPart::stiffness(int node) const {
  const auto [values, axes] = principal_axes(compliance(node, node));
  const Vector3d inverse = (values.array() > 1e-9 * values.maxCoeff()).select(values.cwiseInverse(), 0.0);
  return axes * inverse.asDiagonal() * axes.transpose();
}

double CondensedPart::gap(const DynamicModel& model) const {
  const auto position = [&](int node) -> Vector3d {
    return rest_[node] + (owns(node) ? displacement(node) : model.displacement(node));
  };
  double largest = 0;
  for (const GapPair& pair : gap_) {
    Vector3d opposite = Vector3d::Zero();
    for (int v = 0; v < 3; ++v) opposite += pair.weights[v] * position(pair.triangle[v]);
    largest = std::max(largest, (position(pair.node) - opposite).norm());
  }
  return largest;
}

}  // namespace palpate

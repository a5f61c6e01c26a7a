#include "common/contact/held_points.hpp"

#include <algorithm>
#include <cstring>

#include "common/kernels/kernels.hpp"

namespace palpate {

HeldPoints::HeldPoints(const Response& response, int capacity, const Response* by)
    : response_(response), by_(by), capacity_(capacity), stride_(kernels::leading_dimension(3 * capacity)) {
  anchors_.reserve(capacity);
  sides_.reserve(capacity);
  full_.reserve(capacity);
  raised_.reserve(capacity);
  normals_.reserve(capacity);
  a_.assign(stride_ * stride_, 0.0);
  for (int c = 0; c < 3 * capacity; ++c) columns_.push_back(column(c));
  factor_.assign(stride_ * stride_, 0.0);
  rows_.assign(3 * stride_, 0.0);
  rhs_.assign(stride_, 0.0);
  given_.assign(stride_, 0.0);
  scratch_.assign(kernels::kMaxBlock * stride_, 0.0);
}

double HeldPoints::floor_of(double own) const {
  return kPivotShare * std::max(own, response_.typical());
}

Eigen::Matrix3d HeldPoints::block(int i, int j) const {
  Eigen::Matrix3d b;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) b(r, c) = column(3 * j + c)[3 * i + r];
  return b;
}

void HeldPoints::add(const Anchor& anchor, const ContactSide& by) {
  anchors_.push_back(anchor);
  sides_.push_back(by);
  fill(size() - 1);
}

// The blocks of a point with those before it and with itself.
void HeldPoints::fill(int p) {
  const Anchor* by = std::get_if<Anchor>(&sides_[p]);
  for (int q = 0; q <= p; ++q) {
    Eigen::Matrix3d b = response_.block(anchors_[q], anchors_[p]);
    if (const Anchor* other = std::get_if<Anchor>(&sides_[q]); by && other) b += by_->block(*other, *by);
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) {
        column(3 * p + c)[3 * q + r] = b(r, c);
        column(3 * q + r)[3 * p + c] = b(r, c);
      }
  }
  const ToolPoint* tool = std::get_if<ToolPoint>(&sides_[p]);
  for (int c = 0; tool && c < 3; ++c) column(3 * p + c)[3 * p + c] += tool->softness;
}

void HeldPoints::follow_response() {
  for (int p = 0; p < size(); ++p) fill(p);
  forget_factor();
}

void HeldPoints::remove(int point) {
  const auto in_factor = std::find(full_.begin(), full_.end(), point);
  if (in_factor != full_.end()) {
    const int i = static_cast<int>(in_factor - full_.begin());
    kernels::active().cholesky_remove(factor_.data(), 3 * static_cast<int>(full_.size()), stride_, 3 * i, 3,
                                      scratch_.data());
    full_.erase(in_factor);
    raised_.erase(raised_.begin() + i);
  }
  for (int& p : full_) p -= p > point;
  const int n = 3 * size(), first = 3 * point;
  for (int c = 0; c < n; ++c) {
    if (c >= first && c < first + 3) continue;
    double* to = column(c < first ? c : c - 3);
    const double* from = column(c);
    if (to != from) std::memcpy(to, from, first * sizeof(double));
    std::memmove(to + first, from + first + 3, (n - first - 3) * sizeof(double));
  }
  anchors_.erase(anchors_.begin() + point);
  sides_.erase(sides_.begin() + point);
}

void HeldPoints::clear() {
  anchors_.clear();
  sides_.clear();
  forget_factor();
}

void HeldPoints::forget_factor() {
  full_.clear();
  raised_.clear();
}

void HeldPoints::add_response(int point, const Eigen::Vector3d& change, double* displacement) const {
  const int n = 3 * size();
  const double *x = column(3 * point), *y = column(3 * point + 1), *z = column(3 * point + 2);
  for (int r = 0; r < n; ++r) displacement[r] += x[r] * change.x() + y[r] * change.y() + z[r] * change.z();
}

void HeldPoints::displacements(const double* forces, double* displacement) {
  kernels::active().combine_d(columns_.data(), forces, 3 * size(), 3 * size(), displacement);
}

void HeldPoints::keep_full(std::span<const Hold> hold) {
  for (int i = static_cast<int>(full_.size()) - 1; i >= 0; --i) {
    if (hold[full_[i]] == Hold::all) continue;
    kernels::active().cholesky_remove(factor_.data(), 3 * static_cast<int>(full_.size()), stride_, 3 * i, 3,
                                      scratch_.data());
    full_.erase(full_.begin() + i);
    raised_.erase(raised_.begin() + i);
  }
}

int HeldPoints::append_full(int point) {
  const int n = 3 * static_cast<int>(full_.size());
  double floor[3];
  for (int r = 0; r < 3; ++r) {
    double* row = rows_.data() + stride_ * r;
    for (std::size_t j = 0; j < full_.size(); ++j)
      for (int c = 0; c < 3; ++c) row[3 * j + c] = column(3 * full_[j] + c)[3 * point + r];
    for (int c = 0; c < 3; ++c) row[n + c] = column(3 * point + c)[3 * point + r];
    floor[r] = floor_of(row[n + r]);
  }
  const int raised = kernels::active().cholesky_append(factor_.data(), n, stride_, rows_.data(), stride_, 3, floor);
  full_.push_back(point);
  raised_.push_back(raised);
  return raised;
}

int HeldPoints::append_normal(int point, std::span<const Eigen::Vector3d> normal) {
  const int full = 3 * static_cast<int>(full_.size());
  const Eigen::Vector3d& n = normal[point];
  double* row = rows_.data();
  for (std::size_t j = 0; j < full_.size(); ++j)
    for (int c = 0; c < 3; ++c)
      row[3 * j + c] = n.dot(Eigen::Map<const Eigen::Vector3d>(column(3 * full_[j] + c) + 3 * point));
  for (std::size_t j = 0; j < normals_.size(); ++j)
    row[full + j] = n.dot(block(point, normals_[j]) * normal[normals_[j]]);
  const int size = full + static_cast<int>(normals_.size());
  row[size] = n.dot(block(point, point) * n);
  const double floor = floor_of(row[size]);
  normals_.push_back(point);
  return kernels::active().cholesky_append(factor_.data(), size, stride_, row, stride_, 1, &floor);
}

int HeldPoints::solve(std::span<const Hold> hold, std::span<const Eigen::Vector3d> normal,
                      std::span<const Eigen::Vector3d> target, double* forces) {
  keep_full(hold);
  normals_.clear();
  int raised = 0;
  bool any_given = false;
  for (int p = 0; p < size(); ++p) {
    if (hold[p] == Hold::all && std::find(full_.begin(), full_.end(), p) == full_.end()) append_full(p);
    any_given |= hold[p] == Hold::normal && (forces[3 * p] != 0 || forces[3 * p + 1] != 0 || forces[3 * p + 2] != 0);
  }
  for (int r : raised_) raised += r;
  for (int p = 0; p < size(); ++p)
    if (hold[p] == Hold::normal) raised += append_normal(p, normal);

  if (any_given)
    displacements(forces, given_.data());
  else
    std::fill(given_.begin(), given_.begin() + 3 * size(), 0.0);
  const auto missing = [&](int p) -> Eigen::Vector3d {
    return target[p] - Eigen::Map<const Eigen::Vector3d>(given_.data() + 3 * p);
  };
  int row = 0;
  for (int p : full_) {
    Eigen::Map<Eigen::Vector3d>(rhs_.data() + row) = missing(p);
    row += 3;
  }
  for (int p : normals_) rhs_[row++] = normal[p].dot(missing(p));
  kernels::active().cholesky_solve(factor_.data(), row, stride_, rhs_.data());

  row = 0;
  for (int p : full_) {
    Eigen::Map<Eigen::Vector3d>(forces + 3 * p) += Eigen::Map<const Eigen::Vector3d>(rhs_.data() + row);
    row += 3;
  }
  for (int p : normals_) Eigen::Map<Eigen::Vector3d>(forces + 3 * p) += rhs_[row++] * normal[p];
  return raised;
}

}  // namespace palpate

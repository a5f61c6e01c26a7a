#include <algorithm>

#include "common/dynamics/condensed_part.hpp"

/// Patches on a CondensedPart, whose forces others solve for.
namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using ConstVector = Eigen::Map<const Eigen::VectorXd>;

ConstVector vector(std::span<const double> values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

}  // namespace

void CondensedPart::expect_patches(int patches) {
  pushed_.resize(patches);
  for (auto& forces : pushed_) forces.reserve(Patch::kMaxNodes);
  const std::size_t columns = size_ + 3 * (node_forces_.capacity() + patches * Patch::kMaxNodes);
  columns_.reserve(columns);
  coefficients_.reserve(columns);
}

void CondensedPart::push(int patch, std::span<const PatchForce> forces) {
  pushed_[patch].assign(forces.begin(), forces.end());
}

Vector3d CondensedPart::pushed(int node) const {
  Vector3d u = Vector3d::Zero();
  for (const auto& forces : pushed_) u += respond(node, forces);
  return u;
}

void CondensedPart::draw(int patch, std::span<double> force) const {
  std::ranges::fill(force, 0.0);
  for (const PatchForce& f : pushed_[patch]) add_follow_force(f.node, f.force, force);
}

Matrix3d CondensedPart::give(int node, int under, std::span<const double> inertia) const {
  if (!owns(node) && owns(under)) return give(under, node, inertia).transpose();
  Matrix3d block = compliance(node, under);
  const auto of_connection = vector(inertia);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      const int at = 3 * place_[under] + b;
      if (owns(under))
        block(a, b) += vector(follow(node, a)).cwiseProduct(of_connection).dot(vector(follow(under, b)));
      else if (owns(node))
        block(a, b) += follow(node, a)[at] * inertia[at];
      else if (node == under && a == b)
        block(a, b) += inertia[at];
    }
  return block;
}

}  // namespace palpate

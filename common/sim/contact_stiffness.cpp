#include "common/sim/contact_stiffness.hpp"

#include "common/geometry/dense_solvers.hpp"

namespace palpate {
namespace {

// of a contact's own compliance: contacts that nearly depend on one another stay finite
constexpr double kSoftening = 0.02;

bool knows(const LocalStiffness::Answer& known, const Anchor& a) {
  for (int v = 0; v < 3; ++v)
    if (a.weights[v] != 0 && known.find(a.nodes[v]) < 0) return false;
  return true;
}

/// [m/N] between two anchors on nodes that are known.
Eigen::Matrix3d compliance_between(const LocalStiffness::Answer& known, const Anchor& a, const Anchor& b) {
  Eigen::Matrix3d c = Eigen::Matrix3d::Zero();
  for (int v = 0; v < 3; ++v)
    for (int w = 0; w < 3; ++w)
      if (a.weights[v] != 0 && b.weights[w] != 0)
        c += a.weights[v] * b.weights[w] * known.block(known.find(a.nodes[v]), known.find(b.nodes[w]));
  return c;
}

/// A contact's rows of A: what they take of a force [N], and where they begin.
struct Rows {
  int contact, first;
  Eigen::MatrixXd of_force;
};

}  // namespace

std::vector<Eigen::Matrix3d> contact_stiffness(const LocalStiffness::Answer& known,
                                               std::span<const TouchContact> contacts) {
  std::vector<Eigen::Matrix3d> stiffness(contacts.size(), Eigen::Matrix3d::Zero());
  std::vector<Rows> all;
  int rows = 0;
  for (int i = 0; i < static_cast<int>(contacts.size()); ++i) {
    const TouchContact& c = contacts[i];
    if (c.touch == Touch::open || !knows(known, c.anchor)) continue;
    if (c.touch == Touch::sticking)
      all.push_back({i, rows, Eigen::Matrix3d::Identity()});
    else
      all.push_back({i, rows, c.normal.transpose()});
    rows += static_cast<int>(all.back().of_force.rows());
  }
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows, rows);
  for (const Rows& p : all)
    for (const Rows& q : all)
      a.block(p.first, q.first, p.of_force.rows(), q.of_force.rows()) =
          p.of_force * compliance_between(known, contacts[p.contact].anchor, contacts[q.contact].anchor) *
          q.of_force.transpose();
  for (const Rows& p : all)
    a.block(p.first, p.first, p.of_force.rows(), p.of_force.rows()) +=
        p.of_force * (contacts[p.contact].give + contacts[p.contact].softness() * Eigen::Matrix3d::Identity()) *
        p.of_force.transpose();
  const double typical = rows > 0 ? a.trace() / rows : 0;
  if (!(typical > 0)) return stiffness;
  a.diagonal().array() += kSoftening * typical;
  const Eigen::MatrixXd inverse = invert_semidefinite(a);
  for (const Rows& p : all)
    for (const Rows& q : all) {
      if (!contacts[p.contact].is_by(contacts[q.contact].tool_point().tool)) continue;
      stiffness[p.contact] +=
          p.of_force.transpose() * inverse.block(p.first, q.first, p.of_force.rows(), q.of_force.rows()) * q.of_force;
    }
  return stiffness;
}

}  // namespace palpate

#include "common/models/moving/tissue_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/fem/elasticity.hpp"
#include "common/geometry/arrays.hpp"

namespace palpate {
namespace {

constexpr double kAway = 0.5;  // of a body's diagonal: how far its tissue may be from where it rests

// [Pa] of a material against being pressed while it cannot give way sideways: the largest of its moduli.
double confined_modulus(double young, double poisson) {
  return young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson));
}

}  // namespace

TissueLimits::TissueLimits(const std::vector<Archive>& archives, std::span<const std::uint8_t> moving,
                           std::span<const Eigen::Vector3d> gravity)
    : bodies_(moving.size()) {
  for (std::size_t b = 0; b < moving.size(); ++b) {
    OfBody& body = bodies_[b];
    body.moves = moving[b] != 0;
    any_ |= body.moves;
    const Archive& a = archives[b];
    body.known = body.moves && !a.tetrahedra.empty();
    if (!body.known) continue;
    body.stiffness.assign(a.surface.position.size(), 0);
    for (std::size_t t = 0; t < a.tetrahedra.size(); ++t) {
      const auto& nodes = a.tetrahedra[t];
      const auto at = [&](int v) { return a.surface.position[nodes[v]]; };
      const TetGradients shape = tet_gradients({at(0), at(1), at(2), at(3)});
      const std::size_t m = a.material_of_element.empty() ? 0 : a.material_of_element[t];
      const double modulus = confined_modulus(a.young[m], a.poisson[m]);
      for (int v = 0; v < 4; ++v)
        body.stiffness[nodes[v]] += shape.volume * modulus * shape.gradient.row(v).squaredNorm();
      weight_ += shape.volume * a.density[m] * gravity[b].norm();
    }
    for (const Eigen::Vector3d& force : a.load) weight_ += force.norm();
    const auto plane_modulus = [&](std::size_t m) { return a.young[m] / (1 - a.poisson[m] * a.poisson[m]); };
    body.modulus = plane_modulus(0);
    for (std::size_t m = 0; m < a.young.size(); ++m) contact_modulus_ = std::max(contact_modulus_, plane_modulus(m));
    body.most = *std::ranges::max_element(body.stiffness);
    for (const Eigen::Vector3d& p : a.surface.position) body.rest.extend(p);
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kAway * body.rest.diagonal().norm());
    body.near = {body.rest.min() - margin, body.rest.max() + margin};
  }
}

const TissueLimits::OfBody* TissueLimits::of(std::uint32_t body) const {
  return body < bodies_.size() && bodies_[body].moves ? &bodies_[body] : nullptr;
}

double TissueLimits::reach_at_start(const Eigen::Vector3d& at, double radius) const {
  double reach = 0;
  for (const OfBody& body : bodies_) {
    if (!body.known) continue;
    const double outside = body.rest.exteriorDistance(at);
    const double inside = (at - body.rest.min()).cwiseMin(body.rest.max() - at).minCoeff();
    reach = std::max(reach, outside > 0 ? radius - outside : radius + inside);
  }
  return reach;
}

double TissueLimits::stiffness_of(const LocalContactModel& model) const {
  double most = 0;
  const auto unlimited = [&] { most = std::numeric_limits<double>::infinity(); };
  for (const LocalNode& n : model.nodes) {
    const OfBody* body = of(n.body);
    if (!body) return -1;
    if (!body->known) {
      unlimited();
      continue;
    }
    if (n.node >= body->stiffness.size() || !body->near.contains(vector(n.position))) return -1;
    const double own = body->stiffness[n.node] > 0 ? body->stiffness[n.node] : body->most;
    most = std::max(most, own);
  }
  for (const LocalContact& c : model.contacts) {
    const OfBody* body = of(c.body);
    if (!body) return -1;
    if (!body->known) {
      unlimited();
      continue;
    }
    if (!body->near.contains(vector(c.position))) return -1;
    if (model.nodes.empty()) most = std::max(most, body->most);
  }
  return most;
}

double TissueLimits::modulus_of(const LocalContactModel& model) const {
  double modulus = 0;
  for (const LocalNode& n : model.nodes) {
    const OfBody* body = of(n.body);
    modulus = std::max(modulus, body && body->known ? body->modulus : std::numeric_limits<double>::infinity());
  }
  return modulus;
}

}  // namespace palpate

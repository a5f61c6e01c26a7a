#include "common/models/quasi_static/fine_dents.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/contact/patch/surface_place.hpp"
#include "common/contact/tool_contacts.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kPoints = 60;         // of equal force, for what a tip's pressures are on the nodes
constexpr double kEdgesAround = 6;  // mean edges beside the disc: its reach

/// Numbers, and a unit normal.
bool is_sound(const HeldContact& c) {
  const auto finite = [](const auto& v) { return std::ranges::all_of(v, [](double x) { return std::isfinite(x); }); };
  return finite(c.force) && finite(c.normal) && finite(c.weights) &&
         std::abs(Vector3d(c.normal.data()).norm() - 1) < 1e-6;
}

}  // namespace

FineDents::FineDents(const SurfaceMap& map, const Archive& archive, const HalfSpace& half_space,
                     std::span<const Tool> tools, double resolved)
    : map_(map),
      surface_(map),
      half_space_(half_space),
      tips_(patch_parts(tools, false)),
      edge_(mean_edge(map)),
      widest_(widest_patch(map)) {
  double largest = 0;
  for (const PatchPart& tip : tips_) largest = std::max(largest, std::min(tip.radius, widest_));
  const Compliance<double> compliance(archive, Compliance<double>::Rows::touchable);
  near_field_ = std::make_unique<NearField>(surface_, compliance, half_space, largest, resolved);
  near_field_->subtract(compliance);
}

void FineDents::follow(const ContactsOnBody& contacts) {
  dents_.clear();
  for (const auto& [tool, state] : contacts.of_tool)
    for (const HeldContact& c : state.contacts)
      if (c.body == contacts.body) add_dent(state, c);
}

void FineDents::add_dent(const ContactState& state, const HeldContact& c) {
  const auto tip = std::ranges::find_if(tips_, [&](const PatchPart& part) {
    return part.tool == static_cast<int>(state.tool) && part.part == static_cast<int>(c.sample);
  });
  const auto unknown = [this](std::uint32_t node) { return node >= map_.position.size(); };
  if (tip == tips_.end() || std::ranges::any_of(c.nodes, unknown) || !is_sound(c)) return;
  const Vector3d force(c.force.data()), inward(c.normal.data());
  const double pressing = force.dot(inward);
  if (!(pressing > 0)) return;
  Vector3d middle = Vector3d::Zero();
  for (int v = 0; v < 3; ++v) middle += c.weights[v] * map_.position[c.nodes[v]];
  const double disc = std::min(HertzDent::disc_under(tip->radius, pressing, half_space_), widest_);
  dents_.push_back({middle, -inward, force, disc, disc + kEdgesAround * edge_, half_space_});
}

// Points of Hertz's pressures on a spiral, each with as much force, and the corners below them.
std::vector<FineDents::NodeForce> FineDents::on_nodes(const HertzDent& dent) const {
  std::vector<NodeForce> forces;
  const auto add = [&](int node, const Vector3d& force) {
    const auto known = std::ranges::find(forces, node, &NodeForce::node);
    if (known == forces.end()) return forces.push_back({node, force});
    known->force += force;
  };
  const std::span<const int> near = surface_.near(dent.middle, dent.disc + edge_);
  if (near.empty()) return forces;
  const Vector3d across = dent.outward.unitOrthogonal(), up = dent.outward.cross(across);
  for (int k = 0; k < kPoints; ++k) {
    const double beyond = 1 - (k + 0.5) / kPoints, angle = k * (3 - std::sqrt(5.0)) * std::numbers::pi;
    const double r = dent.disc * std::sqrt(1 - std::pow(beyond, 2.0 / 3));
    const Vector3d point = dent.middle + r * (std::cos(angle) * across + std::sin(angle) * up);
    const TrianglePoint below = nearest_point(surface_, point, near);
    for (int v = 0; v < 3; ++v) add(map_.triangles[below.triangle][v], below.weights[v] / kPoints * dent.force);
  }
  return forces;
}

// Along the normal alone: across it the half-space is not all of what is finer than the mesh.
void FineDents::add(std::vector<Eigen::Vector3f>& displacement) const {
  for (const HertzDent& dent : dents_) {
    const std::vector<NodeForce> forces = on_nodes(dent);
    for (int i = 0; i < map_.touchable; ++i) {
      const double share = dent.share(map_.position[i]);
      if (share == 0) continue;
      const Vector3d& normal = surface_.node_normal(i);
      Vector3d fine = dent.field(map_.position[i], normal);
      for (const NodeForce& f : forces) fine += near_field_->between(i, f.node) * f.force;
      fine = fine.dot(normal) * normal;
      for (int axis = 0; axis < 3; ++axis)
        if (!map_.fixed[i][axis]) displacement[i][axis] += static_cast<float>(share * fine[axis]);
    }
  }
}

}  // namespace palpate

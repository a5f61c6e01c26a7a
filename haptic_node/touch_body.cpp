#include "haptic_node/touch_body.hpp"

#include <algorithm>
#include <limits>

#include "common/kernels/kernels.hpp"

namespace palpate {
namespace {

constexpr int whole_columns_from = 6;  // part of the touchable nodes, one in so many, from which whole columns are read

double bucket_size(const SurfaceMap& map, const Contact& contact) {
  return contact.bucket_size > 0 ? contact.bucket_size : 2 * mean_edge(map);
}

ContactLaw::Rule rule_of(const Contact& contact) {
  return contact.rule == "alpha" ? ContactLaw::Rule::alpha : ContactLaw::Rule::barycentric;
}

}  // namespace

TouchBody::TouchBody(const Archive& archive, const Scene& scene, int body)
    : map_(archive.surface),
      compliance_(archive, Compliance<double>::Rows::touchable),
      law_(compliance_, map_.position, rule_of(scene.contact), scene.contact.friction, max_contacts),
      contacts_(map_, bucket_size(map_, scene.contact), law_, spheres_of(scene)) {
  const Body& b = scene.bodies[body];
  if (b.nonlinear) nonlinear_ = make_quasi_nonlinear(b, archive);
  columns_.reserve(27 * max_contacts);
  coefficients_.reserve(27 * max_contacts);
  displacement_.reserve(3 * map_.size());
  of_tool_.reserve(3 * map_.size());
  whole_.assign(compliance_.stride(), 0.0);
}

void TouchBody::collide(std::span<const MovingTool> tools) {
  update_surface(tools);
  contacts_.collide(tools);
}

void TouchBody::update_surface(std::span<const MovingTool> tools) {
  const std::span<const int> marked = contacts_.mark(tools);
  displacement_.assign(3 * marked.size(), 0.0);
  if (!nonlinear_) {
    superpose(-1, displacement_);
  } else {
    for (int t = 0; t < static_cast<int>(tools.size()); ++t) {
      superpose(t, of_tool_);
      const Eigen::Vector3d press = press_of(t);
      for (std::size_t i = 0; i < marked.size(); ++i) {
        const Eigen::Vector3d u = Eigen::Map<const Eigen::Vector3d>(of_tool_.data() + 3 * i);
        Eigen::Map<Eigen::Vector3d>(displacement_.data() + 3 * i) += nonlinear_->correct(u, press);
      }
    }
    // What is held stays where it is held.
    superpose(-1, of_tool_);
    for (std::size_t i = 0; i < marked.size(); ++i)
      for (const TouchContact& c : law_.contacts())
        if (c.touch != Touch::open && (c.anchor.nodes[0] == marked[i] || (c.face && (c.anchor.nodes[1] == marked[i] ||
                                                                                              c.anchor.nodes[2] == marked[i]))))
          std::copy_n(of_tool_.begin() + 3 * i, 3, displacement_.begin() + 3 * i);
  }
  contacts_.move_marked(displacement_);
}

// u = sum C f over the contacts of one tool, or of all (-1), at the marked nodes.
void TouchBody::superpose(int tool, std::vector<double>& displacement) {
  columns_.clear();
  coefficients_.clear();
  law_.for_each_nodal_force([&](int contact, int node, const Eigen::Vector3d& f) {
    if (node >= compliance_.column_nodes() || (tool >= 0 && law_.contacts()[contact].tool != tool)) return;
    for (int axis = 0; axis < 3; ++axis) {
      columns_.push_back(compliance_.column(node, axis));
      coefficients_.push_back(f[axis]);
    }
  });
  const std::span<const int> marked = surface().marked();
  const int count = static_cast<int>(columns_.size());
  displacement.resize(3 * marked.size());
  // Reading whole columns beats picking from them once a good part of the nodes is asked for.
  if (marked.size() * whole_columns_from < static_cast<std::size_t>(map_.touchable)) {
    kernels::active().combine_nodes_d(columns_.data(), coefficients_.data(), count, marked.data(), static_cast<int>(marked.size()),
                                      displacement.data());
    return;
  }
  kernels::active().combine_d(columns_.data(), coefficients_.data(), count, 3 * map_.touchable, whole_.data());
  for (std::size_t i = 0; i < marked.size(); ++i) std::copy_n(whole_.data() + 3 * marked[i], 3, displacement.data() + 3 * i);
}

LawOutcome TouchBody::hold(std::span<const MovingTool> tools) {
  contacts_.aim(tools);
  const LawOutcome outcome = law_.solve();
  contacts_.settle(tools);
  return outcome;
}

Eigen::Vector3d TouchBody::press_of(int tool) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const TouchContact& c : law_.contacts())
    if (c.tool == tool && c.touch != Touch::open && !c.grasped) sum += c.force.dot(c.normal) * c.normal;
  const double size = sum.norm();
  return size > 0 ? Eigen::Vector3d(sum / size) : Eigen::Vector3d::Zero();
}

void TouchBody::load(std::span<const MovingTool> tools, std::span<ToolLoad> loads) const {
  for (int t = 0; t < static_cast<int>(tools.size()); ++t) {
    loads[t] = {.press = press_of(t)};
    Eigen::Vector3d on_tissue = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
    for (const TouchContact& c : law_.contacts()) {
      if (c.tool != t || c.touch == Touch::open) continue;
      const Eigen::Vector3d at = c.grasped ? c.target : tools[t].centre(tools[t].now, c.sample) + tools[t].samples[c.sample].radius * c.normal;
      on_tissue += c.force;
      moment += (at - tools[t].now.translation()).cross(c.force);
    }
    const double scale = nonlinear_ ? nonlinear_->force_scale(on_tissue.dot(loads[t].press)) : 1.0;
    loads[t].force = -scale * on_tissue;
    loads[t].torque = -scale * moment;
  }
}

double TouchBody::penetration(const Eigen::Vector3d& centre, double radius) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (int t = 0; t < surface().triangle_count(); ++t) nearest = std::min(nearest, closest_point(centre, surface().corners(t)).squared_distance);
  nearest = std::sqrt(nearest);
  return surface().encloses(centre) ? radius + nearest : std::max(0.0, radius - nearest);
}

}  // namespace palpate

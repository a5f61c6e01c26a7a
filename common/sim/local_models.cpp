#include "common/sim/local_models.hpp"

#include <algorithm>

#include "common/geometry/segment.hpp"
#include "common/sim/contact_stiffness.hpp"

namespace palpate {
namespace {

constexpr int kAskedEach = 8;      // ticks from one look at what stiffness is wanted to the next
constexpr int kCondensedFor = 16;  // ticks for which the contacts' stiffness holds while they stay the same

void copy(const Eigen::Vector3d& from, std::array<double, 3>& to) {
  std::copy_n(from.data(), 3, to.begin());
}

void copy(const Eigen::Matrix3d& from, std::array<double, 9>& to) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) to[3 * r + c] = from(r, c);
}

/// The quasi-static part of a hybrid body as its connection nodes feel it.
CondensedPart condensed_part(const Archive& archive, const DynamicOrgan& organ) {
  CondensedPart part;
  if (!archive.hybrid) return part;
  part.part = &organ.still_part()->part();
  const HybridTensors& h = *archive.hybrid;
  part.nodes = h.connection;
  part.stiffness.setZero(3 * h.connection.size(), 3 * h.connection.size());
  const auto place = [&](const Dof& d) {
    return 3 * (std::lower_bound(h.connection.begin(), h.connection.end(), d.node) - h.connection.begin()) + d.axis;
  };
  for (std::size_t i = 0, k = 0; i < h.dofs.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j, ++k)
      part.stiffness(place(h.dofs[i]), place(h.dofs[j])) = part.stiffness(place(h.dofs[j]), place(h.dofs[i])) =
          h.stiffness[k];
  return part;
}

Eigen::Vector3d position_of(const Anchor& anchor, const DynamicOrgan& organ) {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int v = 0; v < 3; ++v)
    if (anchor.weights[v] != 0) position += anchor.weights[v] * organ.position(anchor.nodes[v]);
  return position;
}

}  // namespace

LocalModels::LocalModels(const DynamicWorld& world, const std::vector<Archive>& archives, LocalStiffness::Worker worker)
    : world_(world) {
  for (int i = 0; i < world.organs(); ++i) {
    const ElasticMesh& mesh = world.organ(i).mesh();
    double edges = 0;
    for (const auto& t : mesh.tetrahedra) edges += (mesh.rest[t[0]] - mesh.rest[t[1]]).norm();
    organs_.push_back({.stiffness = std::make_unique<LocalStiffness>(
                           mesh, condensed_part(archives[world.bodies()[i]], world.organ(i)), worker),
                       .look_ahead = 1.5 * edges / static_cast<double>(mesh.tetrahedra.size())});
  }
}

void LocalModels::refresh() {
  if (++ticks_ % kAskedEach != 0) return;
  for (int i = 0; i < world_.organs(); ++i) {
    OfOrgan& own = organs_[i];
    const DynamicOrgan& organ = world_.organ(i);
    if (own.stiffness->take()) own.shape.clear();
    by_distance_.clear();
    bool lacks = own.stiffness->current().topology != organ.removed().size();
    for (int t = 0; t < world_.tools(); ++t) {
      const ToolInTick& tool = world_.in_tick(t);
      if (!tool.present) continue;
      for (int p = 0; p < tool.moving.size(); ++p) {
        const Segment axis = tool.moving.axis(p);
        const double radius = tool.moving.radius(p);
        const auto want = [&](const ContactSurface& surface, int triangle) {
          for (int node : surface.triangle(triangle)) {
            const Eigen::Vector3d& x = surface.positions()[node];
            const double distance = (x - nearest_point(axis, x)).norm() - radius;
            by_distance_.emplace_back(distance, node);
            lacks |= distance < 0.5 * own.look_ahead && own.stiffness->current().find(node) < 0;
          }
        };
        for (int facet : organ.surface().find(axis.start, axis.end, radius + own.look_ahead))
          want(organ.surface(), facet);
        if (!organ.still_part()) continue;
        const TouchSurface& still = organ.still_part()->surface();
        for (int triangle : still.find(axis, axis, radius + own.look_ahead)) want(still, triangle);
      }
    }
    for (const TouchContact& c : organ.contacts())
      for (int v = 0; v < 3; ++v)
        if (c.anchor.weights[v] != 0) {
          by_distance_.emplace_back(-1, c.anchor.nodes[v]);
          lacks |= own.stiffness->current().find(c.anchor.nodes[v]) < 0;
        }
    if (!lacks || by_distance_.empty()) continue;
    std::sort(by_distance_.begin(), by_distance_.end());
    own.wanted.clear();
    for (const auto& [distance, node] : by_distance_) {
      if (static_cast<int>(own.wanted.size()) == LocalStiffness::kMaxNodes) break;
      if (std::find(own.wanted.begin(), own.wanted.end(), node) == own.wanted.end()) own.wanted.push_back(node);
    }
    std::sort(own.wanted.begin(), own.wanted.end());
    own.stiffness->ask(own.wanted, organ.removed());
  }
}

void LocalModels::condense(OfOrgan& own, const DynamicOrgan& organ) {
  const auto contacts = organ.contacts();
  std::vector<std::array<int, 5>> shape;
  for (const TouchContact& c : contacts)
    shape.push_back(
        {c.tool_point().tool, static_cast<int>(c.touch), c.anchor.nodes[0], c.anchor.nodes[1], c.anchor.nodes[2]});
  if (shape == own.shape && ++own.age < kCondensedFor) return;
  own.shape = std::move(shape);
  own.age = 0;
  own.contact = contact_stiffness(own.stiffness->current(), contacts);
}

// Of which moment the model is, and the pose that the tool had.
void LocalModels::add_origin(int tool, LocalContactModel& model) const {
  const ToolState& s = world_.tool(tool).consumed();
  const ToolDofs& pose = world_.in_tick(tool).dofs;
  model.tool = static_cast<std::uint32_t>(tool);
  model.tool_run = s.run;
  model.tool_step = s.step;
  model.sense_ns = s.sense_ns;
  model.yaw = pose.yaw;
  model.pitch = pose.pitch;
  model.depth = pose.depth;
  model.roll = pose.roll;
  model.grip = pose.grip;
}

void LocalModels::add_contacts(int tool, int i, LocalContactModel& model) {
  OfOrgan& own = organs_[i];
  const auto contacts = world_.organ(i).contacts();
  if (std::ranges::none_of(contacts, [&](const TouchContact& c) { return c.is_by(tool); })) return;
  condense(own, world_.organ(i));
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const TouchContact& c = contacts[k];
    const bool pressed = c.touch != Touch::open || !c.force.isZero(0);
    if (!c.is_by(tool) || !pressed || model.contacts.size() == kMaxContacts) continue;
    LocalContact& out = model.contacts.emplace_back();
    out.body = static_cast<std::uint32_t>(world_.bodies()[i]);
    out.grasped = c.grasped;
    copy(c.touch == Touch::open ? c.at : position_of(c.anchor, world_.organ(i)), out.position);
    copy(c.normal, out.normal);
    copy(c.force, out.force);
    copy(own.contact[k], out.stiffness);
  }
}

// The surface nearest to the tool's parts, with each node's own static stiffness.
void LocalModels::add_surface(int tool, int i, LocalContactModel& model) {
  const DynamicOrgan& organ = world_.organ(i);
  const ToolInTick& t = world_.in_tick(tool);
  const LocalStiffness::Answer& answer = organs_[i].stiffness->current();
  by_distance_.clear();
  for (int p = 0; p < t.moving.size(); ++p) {
    const Segment axis = t.moving.axis(p);
    const double radius = t.moving.radius(p);
    for (int facet : organ.surface().find(axis.start, axis.end, radius + organs_[i].look_ahead))
      by_distance_.emplace_back(
          std::sqrt(closest_points(axis, organ.surface().corners(facet)).squared_distance) - radius, facet);
  }
  std::sort(by_distance_.begin(), by_distance_.end());
  add_triangles(
      i, [&](int facet) { return organ.topology().facet(facet); },
      [&](int node, LocalNode& out) {
        copy(organ.surface().positions()[node], out.position);
        copy(organ.model().velocity(node), out.velocity);
        const int known = answer.find(node);
        if (known < 0) return;
        Eigen::Matrix3d c = answer.block(known, known);
        c.diagonal().array() += 1e-6 * c.trace() + 1e-12;
        copy(Eigen::Matrix3d(c.inverse()), out.stiffness);
      },
      model);
}

// The nearest triangles first, until the message is full.
template <class Corners, class Fill>
void LocalModels::add_triangles(int i, Corners&& corners, Fill&& fill, LocalContactModel& model) {
  const auto body = static_cast<std::uint32_t>(world_.bodies()[i]);
  const auto place = [&](int node) -> std::uint32_t {
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      if (model.nodes[n].body == body && model.nodes[n].node == static_cast<std::uint32_t>(node))
        return static_cast<std::uint32_t>(n);
    LocalNode& out = model.nodes.emplace_back();
    out.body = body;
    out.node = static_cast<std::uint32_t>(node);
    fill(node, out);
    return static_cast<std::uint32_t>(model.nodes.size() - 1);
  };
  seen_.clear();
  for (const auto& [distance, triangle] : by_distance_) {
    if (static_cast<int>(model.triangles.size()) == kMaxTriangles ||
        static_cast<int>(model.nodes.size()) + 3 > kMaxNodes)
      break;
    if (std::find(seen_.begin(), seen_.end(), triangle) != seen_.end()) continue;
    seen_.push_back(triangle);
    const auto nodes = corners(triangle);
    const std::uint32_t a = place(nodes[0]), b = place(nodes[1]), c = place(nodes[2]);
    model.triangles.push_back({a, b, c});
  }
}

void LocalModels::add_still_contacts(int tool, int i, LocalContactModel& model) {
  const HybridTouch& still = *world_.organ(i).still_part();
  for (std::size_t k = 0; k < still.contacts().size(); ++k) {
    const TouchContact& c = still.contacts()[k];
    if (!c.is_by(tool) || c.touch == Touch::open || model.contacts.size() == kMaxContacts) continue;
    LocalContact& out = model.contacts.emplace_back();
    out.body = static_cast<std::uint32_t>(world_.bodies()[i]);
    out.grasped = c.grasped;
    copy(anchor_position(c.anchor, still.part().positions()), out.position);
    copy(c.normal, out.normal);
    copy(still.force(static_cast<int>(k)), out.force);
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
    for (int v = 0; v < 3; ++v) stiffness += c.anchor.weights[v] * still.part().stiffness(c.anchor.nodes[v]);
    copy(c.touch == Touch::sliding
             ? Eigen::Matrix3d(c.normal * c.normal.dot(stiffness * c.normal) * c.normal.transpose())
             : stiffness,
         out.stiffness);
  }
}

void LocalModels::add_still_surface(int tool, int i, LocalContactModel& model) {
  const HybridTouch& still = *world_.organ(i).still_part();
  const TouchSurface& surface = still.surface();
  by_distance_.clear();
  const ToolInTick& t = world_.in_tick(tool);
  for (int p = 0; p < t.moving.size(); ++p) {
    const Segment axis = t.moving.axis(p);
    const double radius = t.moving.radius(p);
    for (int triangle : surface.find(axis, axis, radius + organs_[i].look_ahead))
      by_distance_.emplace_back(std::sqrt(closest_points(axis, surface.corners(triangle)).squared_distance) - radius,
                                triangle);
  }
  std::sort(by_distance_.begin(), by_distance_.end());
  add_triangles(
      i, [&](int triangle) { return surface.triangle(triangle); },
      [&](int node, LocalNode& out) {
        copy(surface.positions()[node], out.position);
        copy(still.part().stiffness(node), out.stiffness);
      },
      model);
}

bool LocalModels::describe(int tool, LocalContactModel& model) {
  model.contacts.clear();
  model.nodes.clear();
  model.triangles.clear();
  add_origin(tool, model);
  if (!world_.in_tick(tool).present) return false;
  for (int i = 0; i < world_.organs(); ++i) {
    if (world_.organ(i).passes(tool)) continue;
    add_contacts(tool, i, model);
    add_surface(tool, i, model);
    if (!world_.organ(i).still_part()) continue;
    add_still_contacts(tool, i, model);
    add_still_surface(tool, i, model);
  }
  return !model.contacts.empty() || !model.triangles.empty();
}

void LocalModels::state(State& s) {
  s.value(ticks_);
  for (OfOrgan& own : organs_) {
    own.stiffness->state(s);
    s.list(own.contact);
    s.list(own.shape);
    s.value(own.age);
  }
}

}  // namespace palpate

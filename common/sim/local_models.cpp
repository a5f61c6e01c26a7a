#include "common/sim/local_models.hpp"

#include <algorithm>

#include "common/geometry/arrays.hpp"
#include "common/geometry/segment.hpp"
#include "common/tool/pose_values.hpp"

namespace palpate {
namespace {

constexpr int kAskedEach = 8;  // ticks from one look at what stiffness is wanted to the next

/// The quasi-static part of a hybrid body as its connection nodes feel it.
Condensation condensation_of(const Archive& archive, const DynamicOrgan& organ) {
  Condensation part;
  if (!archive.condensed) return part;
  part.part = &organ.condensed_part()->part();
  const CondensedTensors& h = *archive.condensed;
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

}  // namespace

LocalModels::LocalModels(const DynamicWorld& world, const std::vector<Archive>& archives, LocalStiffness::Worker worker)
    : world_(world) {
  for (int i = 0; i < world.organs(); ++i) {
    const DynamicOrgan& organ = world.organ(i);
    const ElasticMesh& mesh = organ.mesh();
    double edges = 0;
    for (const auto& t : mesh.tetrahedra) edges += (mesh.rest[t[0]] - mesh.rest[t[1]]).norm();
    OfOrgan& own = organs_.emplace_back();
    own.stiffness = std::make_unique<LocalStiffness>(mesh, condensation_of(archives[world.bodies()[i]], organ), worker);
    own.parts = felt_parts(organ, *own.stiffness);
    own.look_ahead = 1.5 * edges / static_cast<double>(mesh.tetrahedra.size());
  }
}

void LocalModels::refresh() {
  if (++ticks_ % kAskedEach != 0) return;
  for (int i = 0; i < world_.organs(); ++i) {
    OfOrgan& own = organs_[i];
    const DynamicOrgan& organ = world_.organ(i);
    if (own.stiffness->take())
      for (const auto& part : own.parts) part->forget();
    by_distance_.clear();
    bool lacks = own.stiffness->current().topology != organ.removed().size();
    for (int t = 0; t < world_.tools(); ++t) {
      const ToolInTick& tool = world_.in_tick(t);
      if (!tool.present) continue;
      for (int p = 0; p < tool.moving.size(); ++p) {
        const Segment axis = tool.moving.axis(p);
        const double radius = tool.moving.radius(p);
        for (const auto& part : own.parts)
          for (int triangle : part->find(axis, radius + own.look_ahead))
            for (int node : part->surface().triangle(triangle)) {
              const Eigen::Vector3d& x = part->surface().positions()[node];
              const double distance = (x - nearest_point(axis, x)).norm() - radius;
              by_distance_.emplace_back(distance, node);
              lacks |= distance < 0.5 * own.look_ahead && own.stiffness->current().find(node) < 0;
            }
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

// Of which moment the model is, and the pose that the tool had.
void LocalModels::add_origin(int tool, LocalContactModel& model) const {
  const ToolState& s = world_.tool(tool).consumed();
  model.tool = static_cast<std::uint32_t>(tool);
  model.tool_run = s.run;
  model.tool_step = s.step;
  model.sense_ns = s.sense_ns;
  model.tissue_ns = world_.time_ns();
  set_pose(pose_values(world_.in_tick(tool).dofs), model);
}

void LocalModels::add_contacts(int tool, int i, FeltPart& part, LocalContactModel& model) {
  const auto contacts = part.contacts();
  if (std::ranges::none_of(contacts, [&](const TouchContact& c) { return c.is_by(tool); })) return;
  part.condense();
  for (int k = 0; k < static_cast<int>(contacts.size()); ++k) {
    const TouchContact& c = contacts[k];
    const Eigen::Vector3d force = part.force(k);
    const bool pressed = c.touch != Touch::open || !force.isZero(0);
    if (!c.is_by(tool) || !pressed || model.contacts.size() == kMaxContacts) continue;
    LocalContact& out = model.contacts.emplace_back();
    out.body = static_cast<std::uint32_t>(world_.bodies()[i]);
    out.grasped = c.grasped;
    copy(c.touch == Touch::open ? c.at : part.position(c.anchor), out.position);
    copy(c.normal, out.normal);
    copy(force, out.force);
    copy(part.stiffness(k), out.stiffness);
  }
}

// The surface nearest to the tool's parts.
void LocalModels::add_surface(int tool, int i, const FeltPart& part, LocalContactModel& model) {
  const ToolInTick& t = world_.in_tick(tool);
  by_distance_.clear();
  for (int p = 0; p < t.moving.size(); ++p) {
    const Segment axis = t.moving.axis(p);
    const double radius = t.moving.radius(p);
    for (int triangle : part.find(axis, radius + organs_[i].look_ahead))
      by_distance_.emplace_back(
          std::sqrt(closest_points(axis, part.surface().corners(triangle)).squared_distance) - radius, triangle);
  }
  std::sort(by_distance_.begin(), by_distance_.end());
  add_triangles(i, part, model);
}

// The nearest triangles first, until the message is full.
void LocalModels::add_triangles(int i, const FeltPart& part, LocalContactModel& model) {
  const auto body = static_cast<std::uint32_t>(world_.bodies()[i]);
  const auto place = [&](int node) -> std::uint32_t {
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      if (model.nodes[n].body == body && model.nodes[n].node == static_cast<std::uint32_t>(node))
        return static_cast<std::uint32_t>(n);
    LocalNode& out = model.nodes.emplace_back();
    out.body = body;
    out.node = static_cast<std::uint32_t>(node);
    part.fill(node, out);
    return static_cast<std::uint32_t>(model.nodes.size() - 1);
  };
  seen_.clear();
  for (const auto& [distance, triangle] : by_distance_) {
    if (static_cast<int>(model.triangles.size()) == kMaxTriangles ||
        static_cast<int>(model.nodes.size()) + 3 > kMaxNodes)
      break;
    if (std::find(seen_.begin(), seen_.end(), triangle) != seen_.end()) continue;
    seen_.push_back(triangle);
    const auto nodes = part.surface().triangle(triangle);
    const std::uint32_t a = place(nodes[0]), b = place(nodes[1]), c = place(nodes[2]);
    model.triangles.push_back({a, b, c});
  }
}

bool LocalModels::describe(int tool, LocalContactModel& model) {
  model.contacts.clear();
  model.nodes.clear();
  model.triangles.clear();
  add_origin(tool, model);
  if (!world_.in_tick(tool).present) return false;
  for (int i = 0; i < world_.organs(); ++i) {
    if (world_.organ(i).passes(tool)) continue;
    for (const auto& part : organs_[i].parts) {
      add_contacts(tool, i, *part, model);
      add_surface(tool, i, *part, model);
    }
  }
  return !model.contacts.empty() || !model.triangles.empty();
}

void LocalModels::state(State& s) {
  s.value(ticks_);
  for (OfOrgan& own : organs_) {
    own.stiffness->state(s);
    for (const auto& part : own.parts) part->state(s);
  }
}

}  // namespace palpate

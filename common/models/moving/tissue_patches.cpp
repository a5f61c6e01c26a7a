#include "common/models/moving/tissue_patches.hpp"

#include <algorithm>
#include <map>

#include "common/contact/patch/local_motion.hpp"
#include "common/contact/patch/patch_parts.hpp"
#include "common/geometry/segment.hpp"
#include "common/models/moving/condensed_nodes.hpp"

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Radii above the surface from which a patch is laid, since tissue swings up to it: of a sphere, and of a segment.
constexpr double kAbove = 0.5, kSegmentAbove = 0.25;
constexpr double kAbout = 3;  // radii, or longest edges, about a patch over which the tissue's motion is taken
// By which the tissue may go [radii] and turn [rad] under a patch before that goes with it: one that followed each
// swing would feed it.
constexpr double kSlackWay = 0.2, kSlackTurn = 0.1;
constexpr double kSlowsBelow = 0.001, kSlowest = 0.1;  // [m], [1]: of what is led out
constexpr double kResolved = 5;                        // edges over which linear elements know the true compliance

std::array<int, 3> ascending(std::array<int, 3> nodes) {
  std::ranges::sort(nodes);
  return nodes;
}

// What goes and turns on is followed by so much less, seen from a place at rest.
Eigen::Isometry3d followed(const Eigen::Isometry3d& before, const Eigen::Isometry3d& now, const Vector3d& place,
                           double slack) {
  Eigen::Isometry3d motion = before;
  const Eigen::AngleAxisd turn(now.linear() * before.linear().transpose());
  if (turn.angle() > kSlackTurn)
    motion.linear() = Eigen::AngleAxisd(turn.angle() - kSlackTurn, turn.axis()) * before.linear();
  const Vector3d gone = now * place - before * place;
  const double left = gone.norm() > slack ? 1 - slack / gone.norm() : 0.0;
  motion.translation() = before * place + left * gone - motion.linear() * place;
  return motion;
}

Segment seen_from(const Eigen::Isometry3d& motion, const Segment& segment) {
  return {motion * segment.start, motion * segment.end};
}

// [m/s] More and more slowly: what is pressed is slower to give way the faster it is pressed.
double led_out(double depth) {
  return Patch::kWayOut * std::clamp(depth / kSlowsBelow, kSlowest, 1.0);
}

}  // namespace

TissuePatches::TissuePatches(const Archive& archive, const ElasticMesh& mesh, const CutMesh& topology,
                             const CutSurface& surface, DynamicModel& model, CondensedTouch* still,
                             const InertialResponse& response, const StepSettings& settings)
    : mesh_(mesh),
      friction_(settings.contact.friction),
      map_(archive.surface),
      surface_(map_),
      longest_edge_(std::ranges::max(longest_edges(map_))),
      triangle_of_facet_(4 * topology.size(), -1),
      facet_of_triangle_(map_.triangles.size(), -1),
      material_{archive.young[0], archive.poisson[0]},
      grids_(material_, widest_patch(map_)),
      ground_of_node_(mesh.rest.size(), 0),
      position_(mesh.rest) {
  std::map<std::array<int, 3>, int> facets;
  for (const int facet : topology.visible()) facets[ascending(topology.facet(facet))] = facet;
  for (int t = 0; t < static_cast<int>(map_.triangles.size()); ++t) {
    const auto found = facets.find(ascending(map_.triangles[t]));
    if (found == facets.end()) continue;
    facet_of_triangle_[t] = found->second;
    triangle_of_facet_[found->second] = t;
  }
  grounds_.push_back({surface, triangle_of_facet_});
  double largest = 0;
  for (const PatchPart& part : patch_parts(settings.tools, true)) {
    parts_.push_back({.tool = part.tool,
                      .part = part.part,
                      .patch = Patch(grids_.of(part.radius, part.length, PatchGrid::Feet::of_cells)),
                      .radius = part.radius,
                      .above = (part.length > 0 ? kSegmentAbove : kAbove) * part.radius});
    largest = std::max(largest, std::min(part.radius, widest_patch(map_)));
  }
  for (Part& own : parts_) {
    const int most = own.patch.max_nodes(), pairs = most * (most + 1) / 2;
    for (std::vector<int>* nodes : {&own.nodes, &own.known}) nodes->reserve(most);
    for (std::vector<NodeGive>* give : {&own.world_give, &own.give}) give->reserve(still ? pairs : most);
    own.last.reserve(most);
    neighbours_.add(own.patch, own.nodes);
  }
  moved_.reserve(Patch::kMaxNodes);
  went_.reserve(Patch::kMaxNodes);
  forces_.reserve(Patch::kMaxNodes);
  if (still) {
    nodes_ = std::make_unique<CondensedNodes>(model, response, still->part(), static_cast<int>(parts_.size()));
    grounds_.push_back({still->surface(), {}});
    for (int t = 0; t < still->surface().triangle_count(); ++t) grounds_.back().triangle.push_back(t);
    for (int node = 0; node < mesh.nodes(); ++node) ground_of_node_[node] = still->part().owns(node);
  } else {
    nodes_ = std::make_unique<TissueNodes>(model, response);
  }
  if (parts_.empty()) return;
  const auto compliance = Compliance<double>::at_rest(archive);
  near_field_ = std::make_unique<NearField>(surface_, compliance, material_, largest, kResolved);
  near_field_->subtract(compliance);
  neighbours_.use(*near_field_);
  leave_out(topology);
}

bool TissuePatches::has_gone(int triangle, const CutMesh& topology) const {
  return facet_of_triangle_[triangle] >= 0 && !topology.is_visible(facet_of_triangle_[triangle]);
}

// Of the triangles that share nodes with it, in the last cut.
bool TissuePatches::loses(const Part& own, const CutMesh& topology) const {
  const auto under = [&](int node) { return std::ranges::count(own.nodes, node) > 0; };
  for (int t = 0; t < static_cast<int>(map_.triangles.size()); ++t)
    if (!surface_.is_left_out(t) && has_gone(t, topology) && std::ranges::any_of(map_.triangles[t], under)) return true;
  return false;
}

void TissuePatches::leave_out(const CutMesh& topology) {
  for (int t = 0; t < static_cast<int>(map_.triangles.size()); ++t)
    if (has_gone(t, topology)) surface_.leave_out(t);
}

// A share of what it did in the last tick.
void TissuePatches::come_loose(const Part& own, double share, std::span<const PatchForce> forces, const Loose& loose) {
  for (const PatchForce& f : forces) loose.forces.push_back({f.node, share * f.force});
  TouchContact contact = own.contact;
  contact.force *= share;
  loose.leave(contact);
}

void TissuePatches::follow_cut(const CutMesh& topology, const Loose& loose) {
  for (Part& own : parts_) {
    if (own.contact.touch == Touch::open || !loses(own, topology)) continue;
    come_loose(own, 1, seen_from_world(own), loose);
    lift(own);
    own.contact.touch = Touch::open;
    own.cut = true;
  }
  leave_out(topology);
  follow_response();
}

void TissuePatches::follow_response() {
  for (Part& own : parts_) own.known.clear();
}

bool TissuePatches::has(int tool, int part) const {
  return std::ranges::any_of(parts_, [&](const Part& own) { return own.tool == tool && own.part == part; });
}

double TissuePatches::give_of_point(double radius) const {
  const double width = 2 * radius;
  return material_.pressed(0, 0, width) / (width * width);
}

bool TissuePatches::laid() const {
  return std::ranges::any_of(parts_, [](const Part& own) { return !own.nodes.empty(); });
}

bool TissuePatches::laid(int tool) const {
  return std::ranges::any_of(parts_, [tool](const Part& own) { return own.tool == tool && !own.nodes.empty(); });
}

bool TissuePatches::leads_in(int tool) const {
  const auto eased = [](const Part& own) { return std::ranges::any_of(own.ease, [](double e) { return e > 0; }); };
  return std::ranges::any_of(parts_, [&](const Part& own) { return own.tool == tool && eased(own); });
}

void TissuePatches::find(std::span<const MovingTool> tools, const std::function<bool(int tool)>& grasps,
                         const Loose& loose) {
  for (Part& own : parts_) {
    own.impulse.setZero();
    if (grasps(own.tool))
      let_go(own, loose);
    else
      lay(own, tools[own.tool], loose);
  }
}

// At rest, below the part: where it pressed, or what is nearest to it now.
bool TissuePatches::find_place(const Part& own, const MovingTool& tool, Vector3d& place) const {
  if (tool.size() <= own.part) return false;  // it passes
  if (own.patch.touches()) {
    place = anchor_position(own.patch.anchor(), map_.position);
    return true;
  }
  const Segment axis = tool.axis(own.part);
  double least = std::pow(own.radius + own.above, 2);
  bool found = false;
  for (const Ground& ground : grounds_)
    for (const int t : ground.surface.find(axis.start, axis.end, std::sqrt(least))) {
      if (ground.triangle[t] < 0) continue;
      const ClosestOfTriangle p = closest_points(axis, ground.surface.corners(t));
      if (!is_nearer(p.squared_distance, least)) continue;
      least = p.squared_distance;
      place = anchor_position({ground.surface.triangle(t), p.weights}, map_.position);
      found = true;
    }
  return found;
}

// Of the tissue, from rest.
Eigen::Isometry3d TissuePatches::motion_about(const Vector3d& place, double within) {
  const std::span<const int> near = surface_.near(place, within);
  for (const int t : near)
    for (const int node : map_.triangles[t])
      position_[node] = grounds_[ground_of_node_[node]].surface.positions()[node];
  return local_motion(surface_, near, place, within, position_);
}

// From one tick to the next the nodes are mostly the same.
void TissuePatches::find_give(Part& own) {
  if (own.known != own.nodes) {
    own.known = own.nodes;
    own.world_give.clear();
    nodes_->add_give(own.nodes, own.world_give);
  }
  const Matrix3d turn = own.motion.linear();
  own.give = own.world_give;
  for (NodeGive& give : own.give) give.block = turn.transpose() * give.block * turn;
}

void TissuePatches::let_go(Part& own, const Loose& loose) {
  if (own.patch.touches()) come_loose(own, 1, seen_from_world(own), loose);
  lift(own);
}

void TissuePatches::lay(Part& own, const MovingTool& tool, const Loose& loose) {
  const std::span<const PatchForce> last = seen_from_world(own);
  Vector3d place;
  if (!find_place(own, tool, place)) return let_go(own, loose);
  const Eigen::Isometry3d motion = motion_about(place, kAbout * std::max(own.radius, longest_edge_));
  const Eigen::Isometry3d before = own.patch.touches() ? own.motion : motion;
  own.motion = followed(before, motion, place, kSlackWay * own.radius);
  const Eigen::Isometry3d to_rest = own.motion.inverse();
  const Segment now = tool.axis(own.part), old = tool.axis_before(own.part), axis = seen_from(to_rest, now);
  own.approach = std::max((now.start - old.start).norm(), (now.end - old.end).norm());
  own.relaid = true;
  const std::span<const int> nodes =
      own.patch.lay({surface_, *near_field_, friction_}, to_rest * tool.before, to_rest * tool.now, axis, own.above);
  if (own.patch.lost() > 0) come_loose(own, own.patch.lost(), last, loose);
  if (nodes.empty()) return lift(own);
  own.nodes.assign(nodes.begin(), nodes.end());
  find_give(own);
  own.last.clear();
  for (const int node : nodes) own.last.push_back(nodes_->displacement(node));
  own.patch.meet({surface_, *near_field_, friction_}, own.give);
}

void TissuePatches::lift(Part& own) {
  nodes_->release(number(own));
  neighbours_.lift(number(own));
  own.patch.lift();
  own.nodes.clear();
  own.ease.fill(0);
  own.depth.fill(0);
}

void TissuePatches::step(std::span<const MovingTool> tools, double dt) {
  for (Part& own : parts_)
    if (!own.nodes.empty()) press(own, tools[own.tool], dt);
}

void TissuePatches::press(Part& own, const MovingTool& tool, double dt) {
  const Eigen::Isometry3d to_rest = own.motion.inverse();
  neighbours_.meet(number(own));
  nodes_->release(number(own));
  const std::vector<Vector3d>& beside = neighbours_.beside(number(own));
  moved_.clear();
  went_.clear();
  for (std::size_t i = 0; i < own.nodes.size(); ++i) {
    const Vector3d u = nodes_->displacement(own.nodes[i]), &rest = mesh_.rest[own.nodes[i]];
    moved_.push_back(to_rest * (rest + u) - rest + beside[i]);
    went_.push_back(to_rest.linear() * (u - own.last[i]));
  }
  Patch::Step step{.before = to_rest * tool.before,
                   .now = to_rest * tool.now,
                   .axis = seen_from(to_rest, tool.axis(own.part)),
                   .moved = moved_,
                   .went = went_,
                   .give = own.give};
  const Patch::Ground ground{surface_, *near_field_, friction_};
  const std::span<double> depth = own.patch.sink(ground, step);
  if (own.relaid) ease_in(own, depth);
  own.relaid = own.cut = false;
  for (std::size_t p = 0; p < depth.size(); ++p) {
    own.depth[p] = depth[p];
    depth[p] -= own.ease[p];
    own.ease[p] = std::max(own.ease[p] - led_out(own.ease[p]) * dt, 0.0);
  }
  own.patch.step(ground, step);
  nodes_->push(number(own), seen_from_world(own), dt);
  for (std::size_t i = 0; i < own.nodes.size(); ++i) own.last[i] = nodes_->displacement(own.nodes[i]);
  own.impulse += dt * (own.motion.linear() * own.patch.force());
}

// What stands deeper than in the last step, beyond what the part and the tissue have moved, has come onto the tissue
// whole: a cell over a rim, or all of a part that is put into it. None of that is felt at once, from twice as deep as
// they explain. The part's own way counts, not that over the tissue: as the patch goes over to tissue that has moved
// otherwise, this is anything.
void TissuePatches::ease_in(Part& own, std::span<const double> depth) const {
  double swing = 0;  // [m]
  for (const Vector3d& went : went_) swing = std::max(swing, std::abs(own.patch.normal().dot(went)));
  const double due = own.cut ? 0 : 2 * own.approach + swing;
  for (std::size_t p = 0; p < depth.size(); ++p) {
    const double deeper = depth[p] - std::max(own.depth[p], 0.0);
    const double whole = std::min(deeper, 2 * std::max(deeper - due, 0.0));
    own.ease[p] = std::clamp(own.ease[p] + whole, 0.0, std::max(depth[p], 0.0));
  }
}

// [N] on the nodes under it.
std::span<const PatchForce> TissuePatches::seen_from_world(const Part& own) {
  forces_.assign(own.patch.forces().begin(), own.patch.forces().end());
  for (PatchForce& f : forces_) f.force = own.motion.linear() * f.force;
  return forces_;
}

void TissuePatches::end_tick(std::span<const MovingTool> tools, double dt) {
  for (Part& own : parts_) {
    TouchContact& c = own.contact;
    c = {.by = ToolPoint{.tool = own.tool, .part = own.part}, .face = true};
    if (own.impulse.isZero(0)) continue;
    const Matrix3d turn = own.motion.linear();
    c.touch = friction_ > 0 && own.patch.sticks() ? Touch::sticking : Touch::sliding;
    c.anchor = own.patch.anchor();
    c.normal = turn * own.patch.normal();
    c.force = own.impulse / dt;
    c.give = turn * own.patch.give() * turn.transpose();
    c.at = c.target = c.position = own.motion * own.patch.at();
    c.tool_point().offset = tools[own.tool].to_part(own.part, c.at);
  }
}

void TissuePatches::add_contacts(std::vector<TouchContact>& contacts) const {
  for (const Part& own : parts_)
    if (own.contact.touch != Touch::open) contacts.push_back(own.contact);
}

void TissuePatches::forget_factor() {
  for (Part& own : parts_) own.patch.forget_factor();
}

void TissuePatches::drop_tool(int tool) {
  for (Part& own : parts_) {
    if (own.tool != tool) continue;
    lift(own);
    own.contact.touch = Touch::open;
  }
}

void TissuePatches::state(State& s) {
  for (Part& own : parts_) {
    own.patch.state(s);
    s.require(own.patch.fits(map_.size()), "the recorded state holds a patch that this body cannot have");
    s.value(own.motion.matrix());
    neighbours_.state(number(own), s);
    s.value(own.ease);
    s.value(own.depth);
    s.value(own.cut);
    s.value(own.contact.touch);
    palpate::state(s, own.contact.anchor);
    for (Vector3d* v : {&own.contact.normal, &own.contact.force, &own.contact.at}) s.value(*v);
    s.value(own.contact.give);
    if (s.restoring()) nodes_->resume(number(own), seen_from_world(own));
  }
}

}  // namespace palpate

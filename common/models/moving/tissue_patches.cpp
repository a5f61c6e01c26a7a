#include "common/models/moving/tissue_patches.hpp"

#include <algorithm>
#include <map>

#include "common/contact/patch/local_motion.hpp"
#include "common/contact/patch/patch_parts.hpp"
#include "common/geometry/triangle.hpp"
#include "common/models/moving/hybrid_nodes.hpp"

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kTip = 0;         // among a probe's parts
constexpr double kAbove = 0.5;  // radii above the surface from which a patch is laid: tissue swings up to it
constexpr double kAbout = 3;    // radii, or longest edges, about a patch over which the tissue's motion is taken
// By which the tissue may go [radii] and turn [rad] under a patch before that goes with it: one that followed each
// swing would feed it.
constexpr double kSlackWay = 0.2, kSlackTurn = 0.1;
constexpr double kResolved = 4;  // edges over which linear elements know the true compliance

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

}  // namespace

TissuePatches::TissuePatches(const Archive& archive, const ElasticMesh& mesh, const CutMesh& topology,
                             const CutSurface& surface, DynamicModel& model, HybridTouch* still,
                             const InertialResponse& response, const StepSettings& settings)
    : mesh_(mesh),
      friction_(settings.contact.friction),
      map_(archive.surface),
      surface_(map_),
      longest_edge_(std::ranges::max(longest_edges(map_))),
      triangle_of_facet_(4 * topology.size(), -1),
      facet_of_triangle_(map_.triangles.size(), -1),
      material_{archive.young[0], archive.poisson[0]},
      grids_(material_),
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
  for (const PatchPart& part : patch_parts(settings.tools, false)) {
    tips_.push_back({.tool = part.tool, .patch = Patch(grids_.of(part.radius)), .radius = part.radius});
    largest = std::max(largest, part.radius);
  }
  constexpr int pairs = Patch::kMaxNodes * (Patch::kMaxNodes + 1) / 2;
  for (Tip& tip : tips_) {
    for (std::vector<int>* nodes : {&tip.nodes, &tip.known}) nodes->reserve(Patch::kMaxNodes);
    for (std::vector<NodeGive>* give : {&tip.world_give, &tip.give}) give->reserve(still ? pairs : Patch::kMaxNodes);
    tip.last.reserve(Patch::kMaxNodes);
  }
  moved_.reserve(Patch::kMaxNodes);
  went_.reserve(Patch::kMaxNodes);
  forces_.reserve(Patch::kMaxNodes);
  if (still) {
    nodes_ = std::make_unique<HybridNodes>(model, response, still->part(), static_cast<int>(tips_.size()));
    grounds_.push_back({still->surface(), {}});
    for (int t = 0; t < still->surface().triangle_count(); ++t) grounds_.back().triangle.push_back(t);
    for (int node = 0; node < mesh.nodes(); ++node) ground_of_node_[node] = still->part().owns(node);
  } else {
    nodes_ = std::make_unique<TissueNodes>(model, response);
  }
  if (tips_.empty()) return;
  const auto compliance = Compliance<double>::at_rest(archive);
  near_field_ = std::make_unique<NearField>(surface_, compliance, material_, largest, kResolved);
  near_field_->subtract(compliance);
  leave_out(topology);
}

bool TissuePatches::has_gone(int triangle, const CutMesh& topology) const {
  return facet_of_triangle_[triangle] >= 0 && !topology.is_visible(facet_of_triangle_[triangle]);
}

// Of the triangles that share nodes with it, in the last cut.
bool TissuePatches::loses(const Tip& tip, const CutMesh& topology) const {
  const auto under = [&](int node) { return std::ranges::count(tip.nodes, node) > 0; };
  for (int t = 0; t < static_cast<int>(map_.triangles.size()); ++t)
    if (!surface_.is_left_out(t) && has_gone(t, topology) && std::ranges::any_of(map_.triangles[t], under)) return true;
  return false;
}

void TissuePatches::leave_out(const CutMesh& topology) {
  for (int t = 0; t < static_cast<int>(map_.triangles.size()); ++t)
    if (has_gone(t, topology)) surface_.leave_out(t);
}

void TissuePatches::follow_cut(const CutMesh& topology, std::vector<PatchForce>& loose,
                               const std::function<void(const TouchContact&)>& leave) {
  for (Tip& tip : tips_) {
    if (tip.contact.touch == Touch::open || !loses(tip, topology)) continue;
    const std::span<const PatchForce> forces = seen_from_world(tip);
    loose.insert(loose.end(), forces.begin(), forces.end());
    leave(tip.contact);
    lift(tip);
    tip.contact.touch = Touch::open;
    tip.cut = true;
  }
  leave_out(topology);
  follow_response();
}

void TissuePatches::follow_response() {
  for (Tip& tip : tips_) tip.known.clear();
}

bool TissuePatches::has(int tool, int part) const {
  return part == kTip && std::ranges::find(tips_, tool, &Tip::tool) != tips_.end();
}

double TissuePatches::give_of_point(double radius) const {
  const double width = 2 * radius;
  return material_.pressed(0, 0, width) / (width * width);
}

bool TissuePatches::laid() const {
  return std::ranges::any_of(tips_, [](const Tip& tip) { return !tip.nodes.empty(); });
}

void TissuePatches::find(std::span<const MovingTool> tools, const std::function<bool(int tool)>& holds) {
  for (Tip& tip : tips_) {
    tip.impulse.setZero();
    if (holds(tip.tool))
      lift(tip);
    else
      lay(tip, tools[tip.tool]);
  }
}

// At rest, below the tip: where it pressed, or what is nearest to it now.
bool TissuePatches::find_place(const Tip& tip, const MovingTool& tool, Vector3d& place) const {
  if (tool.size() == 0) return false;
  if (tip.patch.touches()) {
    place = anchor_position(tip.patch.anchor(), map_.position);
    return true;
  }
  const Vector3d middle = tool.axis(kTip).start;
  double least = std::pow((1 + kAbove) * tip.radius, 2);
  bool found = false;
  for (const Ground& ground : grounds_)
    for (const int t : ground.surface.find(tool.axis_before(kTip).start, middle, std::sqrt(least))) {
      if (ground.triangle[t] < 0) continue;
      const ClosestPoint p = closest_point(middle, ground.surface.corners(t));
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
void TissuePatches::find_give(Tip& tip) {
  if (tip.known != tip.nodes) {
    tip.known = tip.nodes;
    tip.world_give.clear();
    nodes_->add_give(tip.nodes, tip.world_give);
  }
  const Matrix3d turn = tip.motion.linear();
  tip.give = tip.world_give;
  for (NodeGive& give : tip.give) give.block = turn.transpose() * give.block * turn;
}

void TissuePatches::lay(Tip& tip, const MovingTool& tool) {
  Vector3d place;
  if (!find_place(tip, tool, place)) return lift(tip);
  const Eigen::Isometry3d motion = motion_about(place, kAbout * std::max(tip.radius, longest_edge_));
  const Eigen::Isometry3d before = tip.patch.touches() ? tip.motion : motion;
  tip.motion = followed(before, motion, place, kSlackWay * tip.radius);
  const Eigen::Isometry3d to_rest = tip.motion.inverse();
  const Vector3d middle = tool.axis(kTip).start;
  tip.approach = (to_rest * middle - before.inverse() * tool.axis_before(kTip).start).norm();
  tip.relaid = true;
  const std::span<const int> nodes =
      tip.patch.lay({surface_, *near_field_, friction_}, to_rest * tool.before, to_rest * tool.now,
                    {to_rest * middle, to_rest * middle}, kAbove * tip.radius);
  if (nodes.empty()) return lift(tip);
  tip.nodes.assign(nodes.begin(), nodes.end());
  find_give(tip);
  tip.last.clear();
  for (const int node : nodes) tip.last.push_back(nodes_->displacement(node));
  tip.patch.meet({surface_, *near_field_, friction_}, tip.give);
}

void TissuePatches::lift(Tip& tip) {
  nodes_->release(number(tip));
  tip.patch.lift();
  tip.nodes.clear();
  tip.ease.fill(0);
  tip.depth.fill(0);
}

void TissuePatches::step(std::span<const MovingTool> tools, double dt) {
  for (Tip& tip : tips_)
    if (!tip.nodes.empty()) press(tip, tools[tip.tool], dt);
}

void TissuePatches::press(Tip& tip, const MovingTool& tool, double dt) {
  const Eigen::Isometry3d to_rest = tip.motion.inverse();
  nodes_->release(number(tip));
  moved_.clear();
  went_.clear();
  for (std::size_t i = 0; i < tip.nodes.size(); ++i) {
    const Vector3d u = nodes_->displacement(tip.nodes[i]), &rest = mesh_.rest[tip.nodes[i]];
    moved_.push_back(to_rest * (rest + u) - rest);
    went_.push_back(to_rest.linear() * (u - tip.last[i]));
  }
  Patch::Step step{.before = to_rest * tool.before,
                   .now = to_rest * tool.now,
                   .middle = to_rest * tool.axis(kTip).start,
                   .moved = moved_,
                   .went = went_,
                   .give = tip.give};
  const Patch::Ground ground{surface_, *near_field_, friction_};
  const std::span<double> depth = tip.patch.sink(ground, step);
  if (tip.relaid) ease_in(tip, depth);
  tip.relaid = tip.cut = false;
  for (std::size_t p = 0; p < depth.size(); ++p) {
    tip.depth[p] = depth[p];
    depth[p] -= tip.ease[p];
    tip.ease[p] = std::max(tip.ease[p] - kWayOut * dt, 0.0);
  }
  tip.patch.step(ground, step);
  nodes_->push(number(tip), seen_from_world(tip), dt);
  for (std::size_t i = 0; i < tip.nodes.size(); ++i) tip.last[i] = nodes_->displacement(tip.nodes[i]);
  tip.impulse += dt * (tip.motion.linear() * tip.patch.force());
}

// What stands deeper than in the last step, beyond what the tip and the tissue have moved, has come onto the tissue
// whole: a square over a rim, or all of a tip that is put into it.
void TissuePatches::ease_in(Tip& tip, std::span<const double> depth) const {
  double swing = 0;  // [m]
  for (const Vector3d& went : went_) swing = std::max(swing, std::abs(tip.patch.normal().dot(went)));
  const double due = tip.cut ? 0 : 2 * tip.approach + swing;
  for (std::size_t p = 0; p < depth.size(); ++p) {
    const double deeper = depth[p] - std::max(tip.depth[p], 0.0);
    tip.ease[p] = std::clamp(tip.ease[p] + std::max(deeper - due, 0.0), 0.0, std::max(depth[p], 0.0));
  }
}

// [N] on the nodes under it.
std::span<const PatchForce> TissuePatches::seen_from_world(const Tip& tip) {
  forces_.assign(tip.patch.forces().begin(), tip.patch.forces().end());
  for (PatchForce& f : forces_) f.force = tip.motion.linear() * f.force;
  return forces_;
}

void TissuePatches::end_tick(std::span<const MovingTool> tools, double dt) {
  for (Tip& tip : tips_) {
    TouchContact& c = tip.contact;
    c = {.by = ToolPoint{.tool = tip.tool, .part = kTip}, .face = true};
    if (tip.impulse.isZero(0)) continue;
    const Matrix3d turn = tip.motion.linear();
    c.touch = friction_ > 0 && tip.patch.sticks() ? Touch::sticking : Touch::sliding;
    c.anchor = tip.patch.anchor();
    c.normal = turn * tip.patch.normal();
    c.force = tip.impulse / dt;
    c.give = turn * tip.patch.give() * turn.transpose();
    c.at = c.target = c.position = tip.motion * tip.patch.at();
    c.tool_point().offset = tools[tip.tool].to_part(kTip, c.at);
  }
}

void TissuePatches::add_contacts(std::vector<TouchContact>& contacts) const {
  for (const Tip& tip : tips_)
    if (tip.contact.touch != Touch::open) contacts.push_back(tip.contact);
}

void TissuePatches::forget_factor() {
  for (Tip& tip : tips_) tip.patch.forget_factor();
}

void TissuePatches::drop_tool(int tool) {
  for (Tip& tip : tips_) {
    if (tip.tool != tool) continue;
    lift(tip);
    tip.contact.touch = Touch::open;
  }
}

void TissuePatches::state(State& s) {
  for (Tip& tip : tips_) {
    tip.patch.state(s);
    s.require(tip.patch.fits(map_.size()), "the recorded state holds a patch that this body cannot have");
    s.value(tip.motion.matrix());
    s.value(tip.ease);
    s.value(tip.depth);
    s.value(tip.cut);
    s.value(tip.contact.touch);
    palpate::state(s, tip.contact.anchor);
    for (Vector3d* v : {&tip.contact.normal, &tip.contact.force, &tip.contact.at}) s.value(*v);
    s.value(tip.contact.give);
    if (s.restoring()) nodes_->resume(number(tip), seen_from_world(tip));
  }
}

}  // namespace palpate

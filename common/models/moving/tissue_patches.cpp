#include "common/models/moving/tissue_patches.hpp"

#include <algorithm>
#include <map>

#include "common/contact/patch/local_motion.hpp"
#include "common/contact/patch/patch_parts.hpp"
#include "common/geometry/triangle.hpp"

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
constexpr double kResolved = 4;     // edges over which linear elements know the true compliance
constexpr double kFoundDeep = 0.1;  // radii beyond the tool's own motion from which it counts as such

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

HalfSpace material_of(const Archive& archive) {
  return {archive.young[0], archive.poisson[0]};
}

}  // namespace

TissuePatches::TissuePatches(const Archive& archive, const ElasticMesh& mesh, const CutMesh& topology,
                             const CutSurface& surface, DynamicModel& model, const InertialResponse& response,
                             const StepSettings& settings)
    : mesh_(mesh),
      cut_surface_(surface),
      model_(model),
      response_(response),
      friction_(settings.contact.friction),
      map_(archive.surface),
      surface_(map_),
      longest_edge_(std::ranges::max(longest_edges(map_))),
      triangle_of_facet_(4 * topology.size(), -1),
      facet_of_triangle_(map_.triangles.size(), -1),
      grids_(material_of(archive)) {
  std::map<std::array<int, 3>, int> facets;
  for (const int facet : topology.visible()) facets[ascending(topology.facet(facet))] = facet;
  for (int t = 0; t < static_cast<int>(map_.triangles.size()); ++t) {
    const auto found = facets.find(ascending(map_.triangles[t]));
    if (found == facets.end()) continue;
    facet_of_triangle_[t] = found->second;
    triangle_of_facet_[found->second] = t;
  }
  double largest = 0;
  for (const PatchPart& part : patch_parts(settings.tools, false)) {
    tips_.push_back({.tool = part.tool, .patch = Patch(grids_.of(part.radius)), .radius = part.radius});
    largest = std::max(largest, part.radius);
  }
  for (Tip& tip : tips_) {
    tip.nodes.reserve(Patch::kMaxNodes);
    tip.give.reserve(Patch::kMaxNodes);
    tip.last.reserve(Patch::kMaxNodes);
  }
  moved_.reserve(Patch::kMaxNodes);
  went_.reserve(Patch::kMaxNodes);
  if (tips_.empty()) return;
  const auto compliance = Compliance<double>::of_moving_part(archive);
  near_field_ = std::make_unique<NearField>(surface_, compliance, material_of(archive), largest, kResolved);
  near_field_->subtract(compliance);
  follow_cut(topology, {});
}

void TissuePatches::follow_cut(const CutMesh& topology, const std::function<void(const TouchContact&)>& leave) {
  for (const Tip& tip : tips_) {
    if (tip.contact.touch == Touch::open || cut_surface_.facet_of(tip.contact.anchor.nodes) >= 0) continue;
    leave(tip.contact);
  }
  for (std::size_t t = 0; t < facet_of_triangle_.size(); ++t) {
    const int facet = facet_of_triangle_[t];
    if (facet < 0 || !topology.is_visible(facet)) surface_.leave_out(static_cast<int>(t));
  }
}

bool TissuePatches::has(int tool, int part) const {
  return part == kTip && std::ranges::find(tips_, tool, &Tip::tool) != tips_.end();
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
  for (const int facet : cut_surface_.find(tool.axis_before(kTip).start, middle, std::sqrt(least))) {
    const int t = triangle_of_facet_[facet];
    if (t < 0) continue;
    const ClosestPoint p = closest_point(middle, cut_surface_.corners(facet));
    if (p.squared_distance >= least) continue;
    least = p.squared_distance;
    place = anchor_position({cut_surface_.triangle(facet), p.weights}, map_.position);
    found = true;
  }
  return found;
}

void TissuePatches::lay(Tip& tip, const MovingTool& tool) {
  Vector3d place;
  if (!find_place(tip, tool, place)) return lift(tip);
  const Eigen::Isometry3d motion =
      local_motion(surface_, place, kAbout * std::max(tip.radius, longest_edge_), cut_surface_.positions());
  tip.motion = tip.patch.touches() ? followed(tip.motion, motion, place, kSlackWay * tip.radius) : motion;
  const Eigen::Isometry3d to_rest = tip.motion.inverse();
  const Vector3d middle = tool.axis(kTip).start;
  tip.approach = (middle - tool.axis_before(kTip).start).norm();
  tip.met = tip.patch.touches();
  const std::span<const int> nodes =
      tip.patch.lay({surface_, *near_field_, friction_}, to_rest * tool.before, to_rest * tool.now,
                    {to_rest * middle, to_rest * middle}, kAbove * tip.radius);
  if (nodes.empty()) return lift(tip);
  tip.nodes.assign(nodes.begin(), nodes.end());
  tip.give.clear();
  tip.last.clear();
  const Matrix3d turn = tip.motion.linear();
  for (const int node : nodes) {
    tip.give.push_back(turn.transpose() * response_.of_node(node).asDiagonal() * turn);
    tip.last.push_back(displacement(node));
  }
  tip.patch.meet({surface_, *near_field_, friction_}, tip.give);
}

void TissuePatches::lift(Tip& tip) {
  tip.patch.lift();
  tip.nodes.clear();
  tip.ease = 0;
  tip.met = false;
}

void TissuePatches::step(std::span<const MovingTool> tools, double dt) {
  for (Tip& tip : tips_)
    if (!tip.nodes.empty()) press(tip, tools[tip.tool], dt);
}

void TissuePatches::press(Tip& tip, const MovingTool& tool, double dt) {
  const Eigen::Isometry3d to_rest = tip.motion.inverse();
  moved_.clear();
  went_.clear();
  for (std::size_t i = 0; i < tip.nodes.size(); ++i) {
    const Vector3d u = displacement(tip.nodes[i]), &rest = mesh_.rest[tip.nodes[i]];
    moved_.push_back(to_rest * (rest + u) - rest);
    went_.push_back(to_rest.linear() * (u - tip.last[i]));
  }
  Patch::Step step{.before = to_rest * tool.before,
                   .now = to_rest * tool.now,
                   .middle = to_rest * tool.axis(kTip).start,
                   .moved = moved_,
                   .went = went_,
                   .give = tip.give};
  if (!tip.met) {
    const double deep = tip.patch.depth(step) - 2 * tip.approach - kFoundDeep * tip.radius;
    tip.ease = std::max(deep, 0.0);
    tip.met = true;
  }
  step.ease = tip.ease;
  tip.ease = std::max(tip.ease - kWayOut * dt, 0.0);
  tip.patch.step({surface_, *near_field_, friction_}, step);
  const Matrix3d turn = tip.motion.linear();
  for (const PatchForce& f : tip.patch.forces()) {
    const Vector3d moved = response_.of_node(f.node).cwiseProduct(turn * f.force);
    model_.set_motion(f.node, displacement(f.node) + moved, model_.velocity(f.node) + moved / dt);
  }
  for (std::size_t i = 0; i < tip.nodes.size(); ++i) tip.last[i] = displacement(tip.nodes[i]);
  tip.impulse += dt * (turn * tip.patch.force());
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
    s.value(tip.contact.touch);
    s.value(tip.contact.anchor.nodes);
    s.value(tip.contact.anchor.weights);
    for (Vector3d* v : {&tip.contact.normal, &tip.contact.force, &tip.contact.at}) s.value(*v);
    s.value(tip.contact.give);
  }
}

}  // namespace palpate

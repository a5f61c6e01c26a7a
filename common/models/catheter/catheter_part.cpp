#include "common/models/catheter/catheter_part.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/tool/instrument.hpp"

namespace palpate {
namespace {

constexpr std::uint64_t kTaskInterval = 100;  // [steps] from one task record to the next

// A shaft of spheres behind a ball meets a catheter as one segment.
CatheterTool part_of(const MovingTool& tool, int part, bool ball) {
  CatheterTool out{.part = part};
  Segment before = tool.axis_before(part), now = tool.axis(part);
  if (ball && part == 1) {
    before.end = tool.axis_before(tool.size() - 1).start;
    now.end = tool.axis(tool.size() - 1).start;
  }
  out.before = {before.start, before.end};
  out.now = {now.start, now.end};
  out.radius = tool.radius(part);
  return out;
}

void describe(const Task& task, TaskRecord& record) {
  record.inserted = task.inserted;
  record.deepest = task.deepest;
  record.inserting_s = task.inserting_s();
  record.max_force = task.max_force;
  record.wall_contacts = task.wall_contacts;
  record.grasps = task.grasps;
  record.drops = task.drops;
  record.held_s = task.held_s;
}

}  // namespace

CatheterPart::CatheterPart(const CatheterSpec& spec, const StepSettings& settings)
    : inside_(spec.catheter.inside), dt_(settings.dt), jaws_(settings.tools.size(), Eigen::Isometry3d::Identity()) {
  for (int t = 0; t < static_cast<int>(settings.tools.size()); ++t) {
    const Tool& tool = settings.tools[t];
    const bool ball = abilities_of(tool).ball.has_value();
    has_ball_.push_back(ball);
    const int parts = ball ? 2 : static_cast<int>(tool_parts(tool).size());
    for (int p = 0; p < parts; ++p)
      tools_.push_back({.tool = t, .part = p, .compliance = tool.compliance, .friction = settings.contact.friction});
  }
  settings_ = {.shape = spec.catheter,
               .young = spec.material.young,
               .density = spec.material.density,
               .step = settings.dt,
               .friction = settings.contact.friction,
               .max_parts = std::max(static_cast<int>(tools_.size()), 1),
               .max_tools = std::max(static_cast<int>(settings.tools.size()), 1)};
}

void CatheterPart::join(const FindPart& find) {
  BodyPart* duct = find(inside_);
  duct_ = duct ? duct->wall() : nullptr;
  body_ = std::make_unique<CatheterBody>(settings_, duct_);
}

bool CatheterPart::move(std::span<const MovingTool> tools, std::span<ToolLoad> loads) {
  for (CatheterTool& tool : tools_) {
    const CatheterTool now = part_of(tools[tool.tool], tool.part, has_ball_[tool.tool]);
    tool.before = now.before;
    tool.now = now.now;
    tool.radius = now.radius;
  }
  for (std::size_t t = 0; t < tools.size(); ++t) jaws_[t] = tools[t].now;
  body_->step(tools_, jaws_);
  if (duct_) duct_->push(body_->wall_forces());
  for (const CatheterToolForce& f : body_->tool_forces()) {
    loads[f.tool].force -= f.force;
    loads[f.tool].torque -= (f.point - tools[f.tool].now.translation()).cross(f.force);
  }
  return std::ranges::all_of(body_->positions(), [](const Eigen::Vector3d& x) { return x.allFinite(); });
}

void CatheterPart::finish(double max_force, double time) {
  task_.enter_depth(body_->inserted(), time);
  const int touching = body_->wall_contacts();
  task_.wall_contacts += static_cast<std::uint64_t>(std::max(0, touching - wall_contacts_));
  wall_contacts_ = touching;
  task_.max_force = std::max(task_.max_force, max_force);
  bool held = false;
  for (std::size_t t = 0; t < has_ball_.size(); ++t) held |= body_->holds(static_cast<int>(t));
  if (held) task_.held_s += dt_;
}

BetweenJaws CatheterPart::between(const OpenJaws& jaws) {
  BetweenJaws most;
  const double reach = jaws.shape.jaw_length + body_->radius() + body_->spacing();
  const auto x = body_->positions();
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    if ((x[i] - jaws.pose.translation()).squaredNorm() > reach * reach) continue;
    const Segment piece{jaws.pose.inverse() * x[i], jaws.pose.inverse() * x[i + 1]};
    const double opening = opening_at_contact(jaws.shape, piece, body_->radius());
    if (opening > most.opening)
      most = {opening, nearest_point(piece, Eigen::Vector3d(0, 0, jaws.shape.jaw_length / 2)).norm()};
  }
  return most;
}

void CatheterPart::grasp(const OpenJaws& jaws) {
  if (!(between(jaws).opening > 0)) return;
  const ChainPoint point = body_->nearest(jaws.pose * Eigen::Vector3d(0, 0, jaws.shape.jaw_length / 2));
  body_->grasp(jaws.tool, jaws.pose, point, 2 * jaws.shape.jaw_radius, jaws.compliance);
}

void CatheterPart::after_grip(int tool, GripEvent event) {
  task_.grasps += event == GripEvent::taken && body_->holds(tool);
  task_.drops += event == GripEvent::dropped && held_before_;
}

void CatheterPart::state(State& s, std::span<const MovingTool>) {
  body_->state(s);
  s.value(task_);
  s.value(wall_contacts_);
}

std::span<const double> CatheterPart::coordinates() const {
  const auto x = body_->positions();
  return {x.data()->data(), 3 * x.size()};
}

std::vector<BodyNews> CatheterPart::news() const {
  CatheterState state;
  state.position.resize(coordinates().size());
  return {{.message = std::move(state)}, {.message = TaskRecord{}, .interval = kTaskInterval, .to_the_end = true}};
}

void CatheterPart::tell(BodyMessage& message) {
  if (auto* state = std::get_if<CatheterState>(&message)) std::ranges::copy(coordinates(), state->position.begin());
  if (auto* record = std::get_if<TaskRecord>(&message)) describe(task_, *record);
}

std::string CatheterPart::introduction() const {
  const std::string steps = settings_.shape.integrator == ChainIntegrator::implicit
                                ? "implicit, one step a tick"
                                : fmt::format("semi-implicit, {} substeps a tick", body_->substeps());
  return fmt::format("{} particles, {}", body_->size(), steps);
}

std::unique_ptr<BodyPart> make_haptic_part(const CatheterSpec& spec, const Archive&, const StepSettings& settings) {
  return std::make_unique<CatheterPart>(spec, settings);
}

}  // namespace palpate

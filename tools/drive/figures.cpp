#include "tools/drive/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/bus/task_figures.hpp"
#include "common/mesh/near_origin.hpp"
#include "common/models/marked_to_resect.hpp"
#include "tools/drive/pieces.hpp"

namespace palpate::drive {
namespace {

constexpr double kShapeHz = 20;  // at which shapes are looked at

double larger(double a, double b) {
  return b > a || std::isnan(b) ? b : a;  // what is no number stays to be seen
}

const DynamicOrgan* organ_of(const sim::Simulator& simulator, int body) {
  const auto bodies = simulator.tissue().bodies();
  const auto found = std::ranges::find(bodies, body);
  return found == bodies.end() ? nullptr : &simulator.tissue().organ(static_cast<int>(found - bodies.begin()));
}

void add_task(const sim::Simulator& simulator, int body, const std::string& name, Figures& to) {
  for (const TaskRecord& task : simulator.tasks()) {
    if (static_cast<int>(task.body) != body) continue;
    for (const TaskFigure& figure : task_figures())
      to.push_back({name + std::string(figure.name), figure.of(task), std::string(figure.unit)});
  }
}

void add_resection(const Resection& resection, const std::string& name, Figures& to) {
  to.push_back({name + "cut.inside", static_cast<double>(resection.inside().tetrahedra), "1"});
  to.push_back({name + "cut.inside.volume", resection.inside().volume, "m^3"});
  to.push_back({name + "cut.outside", static_cast<double>(resection.outside().tetrahedra), "1"});
  to.push_back({name + "cut.outside.volume", resection.outside().volume, "m^3"});
}

}  // namespace

std::string without_owner(const std::string& name) {
  if (!name.starts_with("tool.") && !name.starts_with("body.")) return {};
  const std::size_t end = name.find('.', 5);
  return end == name.npos ? std::string() : name.substr(0, 4) + name.substr(end);
}

std::optional<Figure> find(const Figures& figures, const std::string& name) {
  std::optional<Figure> found;
  for (const Figure& figure : figures) {
    if (figure.name == name) return figure;
    if (without_owner(figure.name) == name && (!found || larger(found->value, figure.value) != found->value))
      found = figure;
  }
  return found;
}

Watch::Watch(const sim::Simulator& simulator, const std::vector<Archive>& archives)
    : tools_(simulator.tools()),
      bodies_(simulator.bodies()),
      shape_interval_(static_cast<std::uint64_t>(std::max(1l, std::lround(1 / (kShapeHz * simulator.dt()))))) {
  for (int b = 0; b < simulator.bodies(); ++b) {
    const std::vector<Eigen::Vector3d>& rest = archives[b].surface.position;
    bodies_[b].rest = places_from(near_origin(rest), rest);
    const DynamicOrgan* organ = organ_of(simulator, b);
    if (!organ) continue;
    if (const Box* marked = marked_to_resect(simulator.scene().bodies[b]))
      bodies_[b].resection.emplace(*marked, organ->mesh());
  }
}

void Watch::look_at_tool(const sim::Simulator& simulator, int t) {
  const sim::ToolView view = simulator.tool(t);
  OfTool& own = tools_[t];
  own.handling.look(static_cast<double>(steps_) * simulator.dt(), view.pose.translation(), view.force);
  own.last_force = view.force.norm();
  own.max_force = larger(own.max_force, own.last_force);
  own.max_torque = larger(own.max_torque, view.torque.norm());
  own.max_grip = larger(own.max_grip, std::abs(view.grip_torque));
  own.limited += (view.flags & (force_limited | slew_limited)) != 0;
  own.faults += (view.flags & fault) != 0;
  finite_ &= std::isfinite(own.last_force) && std::isfinite(own.max_torque) && std::isfinite(own.max_grip);
}

void Watch::look_at_body(sim::Simulator& simulator, int b) {
  OfBody& own = bodies_[b];
  const DynamicOrgan* organ = organ_of(simulator, b);
  const sim::SurfaceView shown = simulator.surface(b);
  double furthest = 0;
  for (std::size_t n = 0; n < std::min(own.rest.size(), shown.position.size()); ++n) {
    const int node = static_cast<int>(n);
    const bool gone = organ && node < organ->topology().nodes() && !organ->topology().has_node(node) &&
                      !organ->topology().around_node(node).empty();
    if (!gone) furthest = larger(furthest, (shown.position[n] - own.rest[n]).norm());
  }
  own.last_displacement = furthest;
  own.max_displacement = larger(own.max_displacement, furthest);
  finite_ &= std::isfinite(furthest);
}

void Watch::look(sim::Simulator& simulator) {
  for (int t = 0; t < simulator.tools(); ++t) look_at_tool(simulator, t);
  for (const sim::ChangeView& change : simulator.changes()) {
    OfBody& own = bodies_[change.body];
    (change.cause == cut ? own.cut : change.cause == torn ? own.torn : own.fallen) += change.removed.size();
    if (change.cause == cut && own.resection) own.resection->cut(change.removed);
  }
  min_energy_ = std::min(min_energy_, simulator.energy());
  if (++steps_ % shape_interval_ != 0) return;
  for (int b = 0; b < simulator.bodies(); ++b) look_at_body(simulator, b);
}

Figures Watch::figures(const sim::Simulator& simulator) const {
  Figures all{{"seconds", static_cast<double>(steps_) * simulator.dt(), "s"},
              {"finite", finite_ ? 1.0 : 0.0, "1"},
              {"energy.min", min_energy_, "J"}};
  const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
  for (int t = 0; t < simulator.tools(); ++t) {
    const OfTool& own = tools_[t];
    const std::string name = fmt::format("tool.{}.", simulator.scene().tools[t].name);
    all.push_back({name + "force.max", own.max_force, "N"});
    const HandlingFigures handling = own.handling.figures();
    all.push_back({name + "force.mean", handling.mean_force, "N"});
    all.push_back({name + "force.end", own.last_force, "N"});
    all.push_back({name + "force.change", handling.max_change, "N"});
    all.push_back({name + "torque.max", own.max_torque, "N m"});
    all.push_back({name + "grip.max", own.max_grip, "N m"});
    all.push_back({name + "touching", handling.touching, "s"});
    all.push_back({name + "touches", static_cast<double>(handling.touches), "1"});
    all.push_back({name + "path", handling.path, "m"});
    all.push_back({name + "economy", handling.economy, "1"});
    all.push_back({name + "jerk", handling.jerk, "m/s^3"});
    all.push_back({name + "limited", count(own.limited) * simulator.dt(), "s"});
    all.push_back({name + "fault", count(own.faults) * simulator.dt(), "s"});
  }
  for (int b = 0; b < simulator.bodies(); ++b) {
    const OfBody& own = bodies_[b];
    const std::string name = fmt::format("body.{}.", name_of(simulator.scene().bodies[b]));
    all.push_back({name + "displacement.max", own.max_displacement, "m"});
    all.push_back({name + "displacement.end", own.last_displacement, "m"});
    add_task(simulator, b, name, all);
    const DynamicOrgan* organ = organ_of(simulator, b);
    if (!organ) continue;
    const Pieces pieces = pieces_of(*organ);
    all.push_back({name + "cut", count(own.cut), "1"});
    if (own.resection) add_resection(*own.resection, name, all);
    all.push_back({name + "torn", count(own.torn), "1"});
    all.push_back({name + "fallen", count(own.fallen), "1"});
    all.push_back({name + "pieces", static_cast<double>(pieces.count), "1"});
    all.push_back({name + "off", static_cast<double>(pieces.largest_off), "1"});
  }
  return all;
}

}  // namespace palpate::drive

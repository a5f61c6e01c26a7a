#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "common/scene/read_body.hpp"

namespace palpate {

namespace {

const Range kPositive = above(0);

bool parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.normalized().cross(b.normalized()).norm() < 1e-6;
}

/// A direction of length one. One that has it to rounding is kept bit for bit, so that a resolved scene reads
/// back the same.
void read_direction(const TableReader& table, std::string_view key, Eigen::Vector3d& direction) {
  table.vector(key, direction);
  const double length = direction.stableNorm();
  if (!(length > 0)) table.fail_at(key, fmt::format("{} must not be zero", key));
  if (std::abs(length - 1) > 1e-14) direction /= length;
}

Cautery read_cautery(const TableReader& table, double tip_radius) {
  Cautery cautery{tip_radius};
  table.number("radius", cautery.radius, kPositive);
  return cautery;
}

/// Refuses keys of the other kind of tool.
void refuse_keys(const TableReader& table, std::initializer_list<std::string_view> keys, const std::string& kind) {
  for (std::string_view key : keys)
    if (table.has(key)) table.fail_at(key, fmt::format("{} means nothing for a tool of the kind '{}'", key, kind));
}

Jaws read_jaws(const TableReader& table, const std::string& kind) {
  Jaws jaws;
  table.number("length", jaws.length, kPositive);
  if (kind == "forceps") {
    refuse_keys(table, {"width", "closed_below"}, kind);
    table.number("radius", jaws.radius, kPositive);
    table.number("most_open", jaws.most_open, {0, 2.5, false, true});
    table.number("grip_stiffness", jaws.grip_stiffness, kPositive);
    table.number("friction", jaws.friction, at_least(0));
  } else {
    refuse_keys(table, {"radius", "most_open", "grip_stiffness", "friction"}, kind);
    table.number("width", jaws.width, kPositive);
    table.number("closed_below", jaws.closed_below, kPositive);
  }
  return jaws;
}

void read_end(const TableReader& table, Tool& tool) {
  table.choice("kind", tool.kind, {"probe", "forceps"});
  if (tool.kind == "forceps") refuse_keys(table, {"radius", "cautery"}, tool.kind);
  table.number("radius", tool.radius, kPositive);
  if (const auto cautery = table.table("cautery", "[tool.cautery]")) tool.cautery = read_cautery(*cautery, tool.radius);
  if (const auto jaws = table.table("jaws", "[tool.jaws]")) tool.jaws = read_jaws(*jaws, tool.kind);
  if (tool.kind == "forceps" && !tool.jaws)
    table.fail_at("kind", fmt::format("the forceps '{}' needs a [tool.jaws]", tool.name));
}

}  // namespace

Tool read_tool(const TableReader& table) {
  Tool tool;
  table.text("name", tool.name, Need::required);
  check_name(table, tool.name);
  table.vector("pivot", tool.pivot, Need::required);
  read_direction(table, "axis", tool.axis);
  if (!table.has("up") && parallel(tool.axis, tool.up)) tool.up = Eigen::Vector3d::UnitZ();
  read_direction(table, "up", tool.up);
  if (parallel(tool.axis, tool.up)) table.fail_at("up", "up must not be parallel to the tool's axis");
  table.number("shaft_radius", tool.shaft_radius, kPositive);
  table.number("shaft_length", tool.shaft_length, kPositive);
  table.choice("device", tool.device, {"scripted", "log", "bus"});
  if (tool.device == "bus" && table.has("trajectory"))
    table.fail_at("trajectory", "a tool with the device 'bus' is moved by a driver and takes no trajectory");
  if (tool.device != "bus") table.existing_file("trajectory", tool.trajectory, Need::required);
  table.number("compliance", tool.compliance, kPositive);
  table.number("max_force", tool.max_force, kPositive);
  table.number("max_force_rate", tool.max_force_rate, kPositive);
  read_end(table, tool);
  return tool;
}

}  // namespace palpate

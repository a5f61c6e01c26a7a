#include "tools/hold_argument.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string_view>

#include "common/geometry/triangle.hpp"

namespace palpate {
namespace {

using Components = std::array<std::optional<double>, 3>;

std::string_view trim(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// The option's name starts its error sentences.
class Parser {
 public:
  Parser(std::string option, const std::string& text, std::string form)
      : place_(fmt::format("{} \"{}\"", option, text)), form_(std::move(form)) {}

  [[noreturn]] void fail(const std::string& reason) const {
    throw std::runtime_error(fmt::format("{}: {}", place_, reason));
  }

  std::pair<std::string_view, std::string_view> halves(std::string_view text) const {
    const auto colon = text.find(':');
    if (colon == std::string_view::npos || text.find(':', colon + 1) != std::string_view::npos)
      fail("write it as " + form_);
    return {text.substr(0, colon), text.substr(colon + 1)};
  }

  template <class Number>
  Number number(std::string_view text, const char* kind) const {
    text = trim(text);
    if (text.starts_with('+')) text.remove_prefix(1);  // from_chars takes no plus sign
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) fail(fmt::format("'{}' is not {}", text, kind));
    return value;
  }

  Components displacement(std::string_view text) const {
    constexpr double kLargest = 1e3;  // [m]
    const Components result = components(text);
    for (const auto& part : result)
      if (part && std::abs(*part) > kLargest)
        fail(fmt::format("{:g} m is more than {:g} m, the largest displacement that is taken", *part, kLargest));
    return result;
  }

  Components components(std::string_view text) const {
    Components result;
    for (int axis = 0; axis < 3; ++axis) {
      const auto comma = text.find(',');
      if ((comma == std::string_view::npos) != (axis == 2)) fail("three components are needed, as in " + form_);
      const auto part = trim(text.substr(0, comma));
      if (!part.empty()) result[axis] = number<double>(part, "a number");
      if (result[axis] && !std::isfinite(*result[axis])) fail(fmt::format("'{}' is not a finite number", part));
      if (axis < 2) text.remove_prefix(comma + 1);
    }
    return result;
  }

 private:
  std::string place_, form_;
};

void require_node(const std::string& option, const std::string& text, int node, int mesh_nodes) {
  if (node < 0 || node >= mesh_nodes)
    throw std::runtime_error(fmt::format("{} \"{}\": node {} is not in the mesh, which has {} nodes (0 to {})", option,
                                         text, node, mesh_nodes, mesh_nodes - 1));
}

bool empty(const Components& components) {
  return !components[0] && !components[1] && !components[2];
}

}  // namespace

std::vector<Constraint> parse_hold(const std::string& text, const GroupNodes& group) {
  const Parser parser("--hold", text, "NODE:ux,uy,uz");
  const auto [left, right] = parser.halves(text);
  const std::string_view name = trim(left);
  const bool named = group && !name.empty() && std::isalpha(static_cast<unsigned char>(name.front()));
  const auto nodes = named ? group(std::string(name)) : std::vector<int>{parser.number<int>(name, "a node number")};
  const auto displacement = parser.displacement(right);
  if (empty(displacement)) parser.fail("no axis is held");
  std::vector<Constraint> holds;
  for (const int node : nodes)
    for (int axis = 0; axis < 3; ++axis)
      if (displacement[axis]) holds.push_back(hold(node, axis, *displacement[axis]));
  return holds;
}

TouchArgument parse_touch(const std::string& text) {
  const Parser parser("--touch", text, "x,y,z:dx,dy,dz");
  const auto [left, right] = parser.halves(text);
  const auto point = parser.components(left);
  if (!point[0] || !point[1] || !point[2]) parser.fail("the point needs all of x, y, z");
  TouchArgument touch{{*point[0], *point[1], *point[2]}, parser.displacement(right)};
  if (empty(touch.displacement)) parser.fail("no axis is held");
  return touch;
}

std::vector<Constraint> parse_holds(const std::vector<std::string>& texts, int mesh_nodes, const GroupNodes& group) {
  std::vector<Constraint> all;
  std::set<std::pair<int, int>> seen;
  for (const auto& text : texts)
    for (const auto& one : parse_hold(text, group)) {
      const auto& [node, axis, weight] = one.terms[0];
      require_node("--hold", text, node, mesh_nodes);
      if (!seen.insert({node, axis}).second)
        throw std::runtime_error(
            fmt::format("--hold \"{}\": axis {} of node {} is held twice", text, "xyz"[axis], node));
      all.push_back(one);
    }
  return all;
}

std::vector<NodalLoad> parse_forces(const std::vector<std::string>& texts, int mesh_nodes) {
  std::vector<NodalLoad> loads;
  for (const auto& text : texts) {
    const Parser parser("--force", text, "NODE:fx,fy,fz");
    const auto [left, right] = parser.halves(text);
    const int node = parser.number<int>(left, "a node number");
    require_node("--force", text, node, mesh_nodes);
    const auto force = parser.components(right);
    if (!force[0] || !force[1] || !force[2]) parser.fail("the force needs all of x, y, z");
    loads.push_back({node, {*force[0], *force[1], *force[2]}});
  }
  return loads;
}

std::vector<SurfacePressure> parse_pressure(const std::string& text, const std::vector<std::array<int, 3>>& triangles,
                                            const GroupNodes& group) {
  const Parser parser("--pressure", text, "GROUP:p");
  const auto [left, right] = parser.halves(text);
  const double pressure = parser.number<double>(right, "a number");
  if (!std::isfinite(pressure)) parser.fail("the pressure is not a finite number");
  auto pressures = pressures_on(triangles, group(std::string(trim(left))), pressure);
  if (pressures.empty()) parser.fail("the group has no triangle of the surface");
  return pressures;
}

std::vector<Constraint> touch_constraints(const TouchArgument& touch, const std::vector<Eigen::Vector3d>& position,
                                          const std::vector<int>& node_number,
                                          const std::vector<std::array<int, 3>>& triangles) {
  double best = std::numeric_limits<double>::infinity();
  std::array<int, 3> corners{};
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();
  for (const auto& triangle : triangles) {
    const auto closest =
        closest_point(touch.point, {position[triangle[0]], position[triangle[1]], position[triangle[2]]});
    if (closest.squared_distance >= best) continue;
    best = closest.squared_distance;
    corners = triangle;
    weights = closest.weights;
  }
  std::vector<Constraint> constraints;
  for (int axis = 0; axis < 3; ++axis) {
    if (!touch.displacement[axis]) continue;
    Constraint constraint{{}, *touch.displacement[axis]};
    for (int corner = 0; corner < 3; ++corner)
      if (weights[corner] > 0) constraint.terms.push_back({node_number[corners[corner]], axis, weights[corner]});
    constraints.push_back(constraint);
  }
  return constraints;
}

}  // namespace palpate

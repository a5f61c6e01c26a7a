#include "tools/motion/motion_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace palpate {
namespace {

constexpr std::array kUnits{std::pair{"mm", 1e-3}, std::pair{"cm", 1e-2}, std::pair{"m", 1.0}};

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw std::runtime_error(fmt::format("'{}': {}", text, why));
}

/// The number at the beginning, which is taken off.
std::optional<double> take_number(std::string_view& text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  while (text.starts_with(' ')) text.remove_prefix(1);
  return value;
}

/// [m] per unit that the text is; empty if it is none.
std::optional<double> unit_of(std::string_view text) {
  if (text.empty()) return 1.0;
  for (const auto& [name, metres] : kUnits)
    if (text == name) return metres;
  return std::nullopt;
}

Eigen::Vector3d place_of(const std::string& text, std::string_view rest) {
  Eigen::Vector3d place;
  for (int axis = 0; axis < 3; ++axis) {
    std::string_view one = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(one.size() + 1, rest.size()));
    const auto value = take_number(one);
    const auto metres = unit_of(one);
    if (!value || !metres || (axis == 2 && !rest.empty()))
      refuse(text, "a place is X,Y,Z, three lengths in m, cm or mm with commas between them");
    place[axis] = *value * *metres;
  }
  return place;
}

MotionStep press_of(const std::string& text, std::string_view rest) {
  const auto value = take_number(rest);
  if (!value || *value <= 0) refuse(text, "what is pressed is a depth, such as 4mm, or a force, such as 0.5N");
  if (rest == "N") return {.kind = MotionStep::Kind::press_with, .value = *value};
  const auto metres = unit_of(rest);
  if (!metres) refuse(text, "what is pressed is a depth in m, cm or mm, or a force in N");
  return {.kind = MotionStep::Kind::press, .value = *value * *metres};
}

/// A number from `low` to `high` with a unit or none.
double number_of(const std::string& text, std::string_view rest, double low, double high, std::string_view unit) {
  const auto value = take_number(rest);
  if (!value || (!rest.empty() && rest != unit) || !(*value >= low && *value <= high))
    refuse(text, fmt::format("a number from {} to {} is asked for{}{}", low, high, unit.empty() ? "" : ", in ", unit));
  return *value;
}

MotionStep step_of(const std::string& text, std::string_view word, std::string_view rest) {
  using Kind = MotionStep::Kind;
  if (word == "to") return {.kind = Kind::to, .place = place_of(text, rest)};
  if (word == "slide") return {.kind = Kind::slide, .place = place_of(text, rest)};
  if (word == "press") return press_of(text, rest);
  if (word == "hold") return {.kind = Kind::hold, .value = number_of(text, rest, 1e-3, 3600, "s")};
  if (word == "grip") return {.kind = Kind::grip, .value = number_of(text, rest, 0, 3.2, "rad")};
  if (word == "pedal") return {.kind = Kind::pedal, .value = number_of(text, rest, 0, 1, "")};
  if (word == "withdraw" && rest.empty()) return {.kind = Kind::withdraw};
  refuse(text, "a step is to X,Y,Z, press DEPTH or FORCE, hold TIME, slide X,Y,Z, withdraw, grip ANGLE or pedal 0|1");
}

}  // namespace

MotionStep parse_motion_step(const std::string& text) {
  const std::string_view all = text;
  const std::size_t end = all.find(' ');
  MotionStep step = step_of(text, all.substr(0, end), end == all.npos ? "" : all.substr(end + 1));
  step.text = text;
  return step;
}

}  // namespace palpate

#include "tools/drive/expectation.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <stdexcept>

#include "common/scene/nearest.hpp"

namespace palpate::drive {
namespace {

constexpr std::array<std::string_view, 6> kSigns{"<=", ">=", "==", "!=", "<", ">"};  // the longer ones first

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

bool holds(double value, std::string_view sign, double bound) {
  if (std::isnan(value)) return false;
  if (sign == "<") return value < bound;
  if (sign == "<=") return value <= bound;
  if (sign == ">") return value > bound;
  if (sign == ">=") return value >= bound;
  return (value == bound) == (sign == "==");
}

[[noreturn]] void refuse_unknown(const std::string& name, const Figures& figures) {
  std::vector<std::string> known;
  std::string all;
  for (const Figure& figure : figures) {
    known.insert(known.end(), {figure.name, without_owner(figure.name)});
    all += fmt::format("{}{}", all.empty() ? "" : ", ", figure.name);
  }
  const std::vector<std::string_view> names(known.begin(), known.end());
  const std::string_view near = nearest(name, names);
  throw std::runtime_error(fmt::format("--expect: a run of this scene has no figure '{}'; {}", name,
                                       near.empty() ? "it has " + all : fmt::format("did you mean '{}'?", near)));
}

}  // namespace

std::string Expectation::text() const {
  return fmt::format("{}{}{:.10g}", figure, sign, bound);
}

Expectation parse_expectation(std::string_view text) {
  const std::size_t at = text.find_first_of("<>=!");
  for (const std::string_view sign : kSigns) {
    if (at == text.npos || !text.substr(at).starts_with(sign)) continue;
    const std::string_view number = trimmed(text.substr(at + sign.size()));
    Expectation e{std::string(trimmed(text.substr(0, at))), std::string(sign)};
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), e.bound);
    if (error != std::errc() || end != number.data() + number.size() || !std::isfinite(e.bound) || e.figure.empty())
      break;
    return e;
  }
  throw std::runtime_error(fmt::format(
      "--expect '{}': give a figure, one of < <= > >= == != and a number, such as \"tool.force.max<3\"", text));
}

std::string disappointment(const Expectation& expected, const Figures& figures) {
  const std::optional<Figure> figure = find(figures, expected.figure);
  if (!figure) refuse_unknown(expected.figure, figures);
  if (holds(figure->value, expected.sign, expected.bound)) return {};
  const std::string unit = figure->unit.empty() || figure->unit == "1" ? "" : " " + figure->unit;
  return fmt::format("{} is {:.6g}{}, expected {}{:.10g}", figure->name, figure->value, unit, expected.sign,
                     expected.bound);
}

std::string disappointments(const std::vector<Expectation>& expected, const Figures& figures) {
  std::string all;
  for (const Expectation& e : expected)
    if (const std::string why = disappointment(e, figures); !why.empty()) all += (all.empty() ? "" : "; ") + why;
  return all;
}

}  // namespace palpate::drive

#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "tools/drive/figures.hpp"

namespace palpate::drive {

/// What a run is to come to: "tool.force.max<3".
struct Expectation {
  std::string figure, sign;
  double bound = 0;

  std::string text() const;
};

/// Throws std::runtime_error in one sentence.
Expectation parse_expectation(std::string_view text);

/// Why a run is not as expected: "tool.force.max is 3.2 N, expected <3"; empty if it is. What is no number never is.
/// Throws std::runtime_error if there is no such figure, naming the nearest.
std::string disappointment(const Expectation& expected, const Figures& figures);
/// All of them in one; empty if a run is as expected.
std::string disappointments(const std::vector<Expectation>& expected, const Figures& figures);

}  // namespace palpate::drive

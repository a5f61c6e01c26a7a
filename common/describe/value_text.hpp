#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "common/describe/description.hpp"

/// Values as TOML writes them.
namespace palpate::value_text {

/// Shortest text that reads back to the same double, always a TOML float.
std::string number(double x);
std::string vector(const Eigen::Vector3d& v);
std::string text(std::string_view s);
std::string list(const std::vector<std::string>& entries);
std::string box(const Box& box);
std::string axes(const std::array<bool, 3>& axes);  ///< with its quotes
std::string indices(const std::vector<int>& indices);

}  // namespace palpate::value_text

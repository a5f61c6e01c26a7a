#pragma once
#include <functional>
#include <string_view>

namespace palpate {

/// Told each finished stage and the seconds it took.
using Progress = std::function<void(std::string_view stage, double seconds)>;

}  // namespace palpate

#pragma once
#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "common/models/body.hpp"

namespace palpate {

/// Says on standard error which stages of a body's archive have taken long: it is not what was asked for.
inline Progress say_stages(const Body& body) {
  constexpr double kLong = 1;  // [s]
  return [name = name_of(body)](std::string_view stage, double seconds) {
    if (seconds > kLong) fmt::print(stderr, "archive of '{}': {}, {:.1f} s\n", name, stage, seconds);
  };
}

}  // namespace palpate

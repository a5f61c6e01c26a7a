#pragma once
#include <fmt/format.h>

#include <string>

#include "common/cli/progress.hpp"
#include "common/models/body.hpp"

namespace palpate {

/// Says which stages of a body's archive have taken long, or each: it is not what was asked for.
inline Progress say_stages(const Body& body) {
  const double worth = cli::telling() == cli::Telling::everything ? 0 : 1;  // [s]
  return [name = name_of(body), worth](std::string_view stage, double seconds) {
    if (seconds > worth) cli::say(fmt::format("archive of '{}': {}, {:.1f} s", name, stage, seconds));
  };
}

}  // namespace palpate

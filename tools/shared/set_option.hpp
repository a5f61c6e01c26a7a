#pragma once
#include <string>
#include <vector>

#include "common/cli/command_line.hpp"

namespace palpate {

/// --set of a command that reads scenes; `set` is for parse_changes().
inline cli::Option add_set_option(cli::Command& command, std::vector<std::string>& set) {
  return command
      .add_option("--set", set,
                  "KEY=VALUE in place of what a scene file says, such as body.young=8000; may be repeated")
      .one_value_each_time();
}

}  // namespace palpate

#pragma once
#include "common/cli/command_line.hpp"

/// One function per sub-command of `palpate_study`, which `palpate` starts. The callbacks throw std::exception on
/// failure; main prints the sentence and exits with 1.
namespace palpate {

void add_study_command(cli::Command& app);
void add_stability_command(cli::Command& app);

}  // namespace palpate

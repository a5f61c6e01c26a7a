#pragma once
#include "common/cli/command_line.hpp"

/// One function per sub-command of `palpate_organ`, which `palpate` starts. The callbacks throw std::exception on
/// failure; main prints the sentence and exits with 1.
namespace palpate {

void add_mesh_command(cli::Command& app);
void add_organ_command(cli::Command& app);
void add_segment_command(cli::Command& app);

}  // namespace palpate

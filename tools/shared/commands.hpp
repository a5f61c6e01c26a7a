#pragma once
#include "common/cli/command_line.hpp"

/// One function per sub-command of `palpate`, each in the file of its name. The callbacks throw
/// std::exception on failure; main prints the sentence and exits with 1.
namespace palpate {

void add_check_command(cli::Command& app);
void add_precompute_command(cli::Command& app);
void add_solve_command(cli::Command& app);
void add_modes_command(cli::Command& app);
void add_run_command(cli::Command& app);
void add_record_command(cli::Command& app);
void add_info_command(cli::Command& app);
void add_drive_command(cli::Command& app);
void add_export_command(cli::Command& app);
void add_latency_command(cli::Command& app);
void add_replay_command(cli::Command& app);
void add_top_command(cli::Command& app);
void add_network_command(cli::Command& app);
void add_keys_command(cli::Command& app);
void add_scene_command(cli::Command& app);
void add_motion_command(cli::Command& app);
void add_cache_command(cli::Command& app);
void add_commands_of_other_programs(cli::Command& app);  ///< those of `palpate_organ` and `palpate_study`, for the help

/// Becomes the program that has the command of the command line, if another one has it. Throws std::runtime_error where
/// that is not installed.
void start_other_program(char** argv);

}  // namespace palpate

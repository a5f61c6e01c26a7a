#pragma once
#include <CLI/CLI.hpp>

/// One function per sub-command of `palpate`, each in the file of its name. The callbacks throw
/// std::exception on failure; main prints the sentence and exits with 1.
namespace palpate {

void add_check_command(CLI::App& app);
void add_precompute_command(CLI::App& app);
void add_solve_command(CLI::App& app);
void add_stability_command(CLI::App& app);
void add_study_command(CLI::App& app);
void add_run_command(CLI::App& app);
void add_record_command(CLI::App& app);
void add_info_command(CLI::App& app);
void add_export_command(CLI::App& app);
void add_latency_command(CLI::App& app);
void add_replay_command(CLI::App& app);
void add_top_command(CLI::App& app);
void add_keys_command(CLI::App& app);

}  // namespace palpate

#include <cstdio>
#include <exception>

#include "common/fem/processor_blas.hpp"
#include "tools/commands.hpp"

int main(int argc, char** argv) {
  palpate::use_blas_of_this_processor(argv);
  palpate::cli::CommandLine app{"palpate: a distributed haptic simulator of soft tissue"};
  app.show_version(PALPATE_VERSION);
  app.require_command();
  palpate::add_check_command(app);
  palpate::add_precompute_command(app);
  palpate::add_run_command(app);
  palpate::add_drive_command(app);
  palpate::add_record_command(app);
  palpate::add_info_command(app);
  palpate::add_export_command(app);
  palpate::add_latency_command(app);
  palpate::add_replay_command(app);
  palpate::add_solve_command(app);
  palpate::add_modes_command(app);
  palpate::add_stability_command(app);
  palpate::add_study_command(app);
  palpate::add_top_command(app);
  palpate::add_keys_command(app);
  palpate::add_organ_commands(app);
  palpate::add_scene_command(app);
  try {
    palpate::start_organ_program(argv);
    if (const auto status = app.read(argc, argv)) return *status;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate: %s\n", error.what());
    return 1;
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
    std::fprintf(stderr, "palpate: not all that was to be printed could be written\n");
    return 1;
  }
  return 0;
}

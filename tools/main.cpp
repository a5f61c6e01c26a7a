#include "common/fem/processor_blas.hpp"
#include "tools/shared/commands.hpp"

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
  palpate::add_top_command(app);
  palpate::add_network_command(app);
  palpate::add_keys_command(app);
  palpate::add_cache_command(app);
  palpate::add_commands_of_other_programs(app);
  palpate::add_scene_command(app);
  palpate::add_motion_command(app);
  return app.run(argc, argv, [argv] { palpate::start_other_program(argv); });
}

#include "common/fem/processor_blas.hpp"
#include "tools/study/commands.hpp"

int main(int argc, char** argv) {
  palpate::use_blas_of_this_processor(argv);
  palpate::cli::CommandLine app{"Studies of error, run time and stability; started by `palpate`"};
  app.show_version(PALPATE_VERSION);
  app.require_command();
  app.examples({"palpate study scenes/plate.toml --quick -o out/study", "palpate stability --quick -o out/stability"});
  palpate::add_study_command(app);
  palpate::add_stability_command(app);
  return app.run(argc, argv);
}

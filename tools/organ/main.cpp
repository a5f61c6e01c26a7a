#include "tools/organ/commands.hpp"

int main(int argc, char** argv) {
  palpate::cli::CommandLine app{"Makes organs of surfaces and of images; started by `palpate`"};
  app.show_version(PALPATE_VERSION);
  app.require_command();
  app.examples(
      {"palpate organ liver.inr.gz --label 255=liver -o organ.msh", "palpate mesh liver.stl --unit mm -o liver.msh"});
  palpate::add_mesh_command(app);
  palpate::add_organ_command(app);
  palpate::add_segment_command(app);
  return app.run(argc, argv);
}

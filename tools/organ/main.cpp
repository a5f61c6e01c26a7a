#include <cstdio>
#include <exception>

#include "tools/organ/commands.hpp"

int main(int argc, char** argv) {
  palpate::cli::CommandLine app{"Makes organs of surfaces and of images; started by `palpate`"};
  app.show_version(PALPATE_VERSION);
  app.require_command();
  palpate::add_mesh_command(app);
  palpate::add_organ_command(app);
  try {
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

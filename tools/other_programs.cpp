#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "tools/shared/child_process.hpp"
#include "tools/shared/commands.hpp"

namespace palpate {
namespace {

struct OtherProgram {
  const char *name, *where;
};
constexpr OtherProgram kOrgan{
    "palpate_organ", "`scripts/build.sh release palpate_organ` builds it where CGAL is, on Debian with libcgal-dev"};
constexpr OtherProgram kFilm{"palpate_film", "`scripts/build.sh release palpate_film` builds it"};
constexpr OtherProgram kStudy{"palpate_study", "`scripts/build.sh release palpate_study` builds it"};

struct OtherCommand {
  const char *name, *meaning;
  const OtherProgram& program;
};
constexpr std::array kCommands{
    OtherCommand{"film", "Draw a topic log, every picture that is due", kFilm},
    OtherCommand{"path", "Draw the way of a tool's tip over the organ at rest", kFilm},
    OtherCommand{"report", "A page of recorded sessions: force, path, pictures and figures of skill", kFilm},
    OtherCommand{"mesh", "Make a mesh of tetrahedra of a surface (STL, OBJ, PLY, OFF, VTK, VTP)", kOrgan},
    OtherCommand{"organ", "Make a mesh of tetrahedra of labels in an image (INR, NIfTI, MetaImage, NRRD, DICOM)",
                 kOrgan},
    OtherCommand{"segment",
                 "Make a label of an organ's grey values, slice by slice (INR, NIfTI, MetaImage, NRRD, DICOM)", kOrgan},
    OtherCommand{"stability", "Stiff and extreme cases, each with its outcome, as a table and a page", kStudy},
    OtherCommand{"study", "Error against run time of all that can serve a scene", kStudy}};

}  // namespace

void add_commands_of_other_programs(cli::Command& app) {
  for (const OtherCommand& command : kCommands) app.add_command(command.name, command.meaning);
}

void start_other_program(char** argv) {
  const bool helps = argv[1] && std::string_view(argv[1]) == "help";  // "help NAME" is the same there
  const char* name = argv[helps ? 2 : 1];
  const auto* command = std::ranges::find_if(
      kCommands, [&](const OtherCommand& other) { return name && other.name == std::string_view(name); });
  if (command == kCommands.end()) return;
  const auto& [program_name, where] = command->program;
  const std::string program = sibling_program(program_name);
  execv(program.c_str(), argv);
  if (errno == ENOENT)
    throw std::runtime_error(fmt::format("`palpate {}` is in a program of its own that is not here, {}: {}",
                                         command->name, program_name, where));
  throw std::runtime_error(fmt::format("cannot start {}: {}", program, std::strerror(errno)));
}

}  // namespace palpate

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "tools/child_process.hpp"
#include "tools/commands.hpp"

namespace palpate {
namespace {

constexpr std::array kOrganCommands{
    std::pair{"mesh", "Make a mesh of tetrahedra of a surface (STL, OBJ, PLY, OFF, VTK, VTP)"},
    std::pair{"organ", "Make a mesh of tetrahedra of labels in an image (INR, NIfTI, MetaImage, NRRD, DICOM)"}};

}  // namespace

void add_organ_commands(cli::Command& app) {
  for (const auto& [name, meaning] : kOrganCommands) app.add_command(name, meaning);
}

void start_organ_program(char** argv) {
  const auto is_named = [&](const auto& command) { return argv[1] && std::string_view(argv[1]) == command.first; };
  if (std::ranges::none_of(kOrganCommands, is_named)) return;
  const std::string program = sibling_program("palpate_organ");
  execv(program.c_str(), argv);
  if (errno == ENOENT)
    throw std::runtime_error(fmt::format(
        "`palpate {}` is in a program of its own that is not installed here, palpate_organ: it is built where CGAL is, "
        "on Debian with libcgal-dev",
        argv[1]));
  throw std::runtime_error(fmt::format("cannot start {}: {}", program, std::strerror(errno)));
}

}  // namespace palpate

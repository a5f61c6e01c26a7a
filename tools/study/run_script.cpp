#include "tools/study/run_script.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include "common/realtime/shutdown.hpp"

namespace palpate {
namespace {

std::filesystem::path find_script(const std::string& name) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  for (const std::filesystem::path& folder :
       {program / "../share/palpate/scripts", std::filesystem::path(PALPATE_SOURCE_DIR "/scripts")})
    if (std::filesystem::exists(folder / name)) return folder / name;
  return {};
}

std::string quoted(const std::filesystem::path& path) {
  std::string text(1, '\'');
  for (const char c : path.string()) c == '\'' ? text.append("'\\''") : text.append(1, c);
  text.push_back('\'');
  return text;
}

}  // namespace

std::string run_script(const std::string& name, const std::filesystem::path& folder) {
  const auto script = find_script(name);
  if (script.empty())
    return fmt::format(
        "no page was made: {} is neither installed nor in the source tree; the figures are in the CSV files", name);
  // The system's interpreter first: it is the one that has the packages of scripts/install.sh.
  const std::string python = std::filesystem::exists("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
  const int status = std::system(fmt::format("{} {} {}", python, quoted(script), quoted(folder)).c_str());
  if (status == 0) return {};
  if (WIFSIGNALED(status) || WEXITSTATUS(status) == 128 + SIGINT)
    throw Interrupted(fmt::format("stopped before the page of {} was made", folder.string()));
  return "no page was made, for which python3 needs matplotlib; the figures are in the CSV files";
}

}  // namespace palpate

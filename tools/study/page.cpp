#include "tools/study/page.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

#include "common/kernels/code_path.hpp"

namespace palpate::study {
namespace {

/// Beside the program in an installation, else in the source tree.
std::filesystem::path script() {
  const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  for (const std::filesystem::path& place :
       {program / "../share/palpate/scripts/study_page.py",
        std::filesystem::path(PALPATE_SOURCE_DIR "/scripts/study_page.py")})
    if (std::filesystem::exists(place)) return place;
  return {};
}

std::string quoted(const std::filesystem::path& path) {
  std::string text(1, '\'');
  for (const char c : path.string()) c == '\'' ? text.append("'\\''") : text.append(1, c);
  text.push_back('\'');
  return text;
}

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

}  // namespace

std::string make_page(const std::filesystem::path& folder) {
  const auto place = script();
  if (place.empty()) return "scripts/study_page.py is not there: the figures are in the CSV files alone";
  // The system's interpreter first: it is the one that has the packages of scripts/install.sh.
  const std::string python = std::filesystem::exists("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
  const std::string command = fmt::format("{} {} {}", python, quoted(place), quoted(folder));
  if (std::system(command.c_str()) == 0) return {};
  return "python3 with matplotlib made no page: the figures are in the CSV files alone";
}

void describe_machine(const std::filesystem::path& folder) {
  std::ofstream out(folder / "machine.txt");
  out << fmt::format("{}, {} cores; palpate {} ({}); {:%Y-%m-%d %H:%M}\n", processor(),
                     std::thread::hardware_concurrency(), PALPATE_VERSION, code_path(),
                     fmt::localtime(std::time(nullptr)));
}

}  // namespace palpate::study

#include "tools/study/machine.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <thread>

#include "common/kernels/code_path.hpp"

namespace palpate::study {
namespace {

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

}  // namespace

void describe_machine(const std::filesystem::path& folder, int jobs) {
  const std::string today =
      fmt::format("{}, {} cores{}; palpate {} ({}); {:%Y-%m-%d}", processor(), std::thread::hardware_concurrency(),
                  jobs > 1 ? fmt::format(", {} settings at the same time", jobs) : "", PALPATE_VERSION, code_path(),
                  fmt::localtime(std::time(nullptr)));
  std::ifstream in(folder / "machine.txt");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(today)) return;
  std::ofstream(folder / "machine.txt", std::ios::app)
      << fmt::format("{} {:%H:%M}\n", today, fmt::localtime(std::time(nullptr)));
}

}  // namespace palpate::study

#include "tools/stability/wait_for_workers.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace palpate::stability {
namespace {

/// proc(5): the state follows the name, which is in brackets.
bool sleeps(const std::filesystem::path& task) {
  std::ifstream in(task / "stat");
  std::string line;
  std::getline(in, line);
  const auto name_end = line.rfind(')');
  return name_end == line.npos || line.compare(name_end, 3, ") S") == 0;
}

bool all_sleep() {
  const std::string self = std::to_string(gettid());
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task"))
    if (task.path().filename() != self && !sleeps(task.path())) return false;
  return true;
}

}  // namespace

void wait_for_workers() {
  while (!all_sleep()) usleep(50);
}

}  // namespace palpate::stability

#pragma once
#include <functional>
#include <string>
#include <vector>

namespace palpate {

/// What is heard of commands that run in processes of their own, each named by its place in their list.
struct ChildrenSay {
  std::function<void(std::size_t command, const std::string& line)> printed;
  std::function<void(std::size_t command, int status)> ended;  ///< exit status; 128 + signal
};

/// Runs each command in a process of its own, `jobs` at a time; `name` is what errors call them. Returns once all have
/// ended; after a shutdown signal it ends those that run, of which nothing more is heard. Throws std::runtime_error
/// where a program cannot be started.
void run_children(const std::string& name, const std::vector<std::vector<std::string>>& commands, int jobs,
                  const ChildrenSay& say);

}  // namespace palpate

#pragma once
#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace palpate {

/// A program started by this one, its standard output on a pipe. It dies with its parent, and the destructor
/// stops it (SIGINT, then SIGKILL).
class ChildProcess {
 public:
  /// Throws std::runtime_error if the program cannot be started.
  ChildProcess(std::string name, const std::vector<std::string>& arguments);
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess(const ChildProcess&) = delete;

  const std::string& name() const { return name_; }
  pid_t pid() const { return pid_; }
  int output() const { return output_; }  ///< read end, non-blocking
  bool running();                         ///< reaps the process if it has ended
  int status() const { return status_; }  ///< exit status; 128 + signal; meaningful once it has ended
  void interrupt();                       ///< SIGINT
  void kill();                            ///< SIGKILL, and reaps it
  bool wait(std::chrono::milliseconds timeout);

  /// Complete lines that have come since the last call.
  std::vector<std::string> take_lines();

 private:
  std::string name_, partial_;
  pid_t pid_ = -1;
  int output_ = -1;
  int status_ = 0;
};

/// The program NAME that lies beside this one.
std::string sibling_program(const std::string& name);

}  // namespace palpate

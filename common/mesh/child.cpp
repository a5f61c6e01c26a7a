#include "common/mesh/child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

namespace palpate {
namespace {

constexpr rlim_t kSecondsAllowed = 60;  // of processor time; the largest mesh in use reads in well under one
constexpr rlim_t kMemoryAllowed = rlim_t{8} << 30;

// Sanitizers reserve terabytes of addresses, so that no limit can be set under them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitMemory = false;
#else
constexpr bool kLimitMemory = true;
#endif

bool write_all(int file, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = write(file, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno != EINTR) return false;
    if (n > 0) done += static_cast<std::size_t>(n);
  }
  return true;
}

std::string read_all(int file) {
  const off_t size = lseek(file, 0, SEEK_END);
  std::string bytes(size > 0 ? static_cast<std::size_t>(size) : 0, '\0');
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = pread(file, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
    if (n <= 0) throw std::runtime_error("the reader's answer could not be fetched");
    done += static_cast<std::size_t>(n);
  }
  return bytes;
}

void close_terminal() {
  const int null = open("/dev/null", O_RDWR);
  for (int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(null, stream);
}

// The first byte of the answer tells a result ('=') from an error message ('!').
std::string answer_of(const std::function<std::string()>& work) {
  try {
    return '=' + work();
  } catch (const std::exception& error) {
    return std::string("!") + error.what();
  } catch (const std::string& message) {
    return '!' + message;
  } catch (...) {
    return "!the reader failed without a reason";
  }
}

[[noreturn]] void be_child(int file, const std::function<std::string()>& work) {
  const rlimit time{kSecondsAllowed, kSecondsAllowed}, no_core{0, 0}, memory{kMemoryAllowed, kMemoryAllowed};
  setrlimit(RLIMIT_CPU, &time);
  setrlimit(RLIMIT_CORE, &no_core);
  if (kLimitMemory) setrlimit(RLIMIT_AS, &memory);
  for (int s : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGINT, SIGTERM}) std::signal(s, SIG_DFL);
  close_terminal();
  _exit(write_all(file, answer_of(work)) ? 0 : 1);
}

std::string how_it_ended(int status) {
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL)) {
    return "the reader was stopped, it took too long or too much memory";
  }
  if (WIFSIGNALED(status)) return fmt::format("the reader crashed (signal {})", WTERMSIG(status));
  return "the reader ended without an answer";
}

struct Descriptor {
  int number;
  ~Descriptor() { close(number); }
};

}  // namespace

std::string run_in_child(const std::function<std::string()>& work) {
  const Descriptor answer_file{memfd_create("palpate", MFD_CLOEXEC)};
  if (answer_file.number < 0) throw std::runtime_error(fmt::format("no memory file: {}", std::strerror(errno)));
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error(fmt::format("no process for the reader: {}", std::strerror(errno)));
  if (child == 0) be_child(answer_file.number, work);

  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::runtime_error("the reader's process was lost");
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw ChildDied(how_it_ended(status));
  const std::string answer = read_all(answer_file.number);
  if (answer.empty()) throw std::runtime_error("the reader ended without an answer");
  if (answer[0] == '!') throw std::runtime_error(answer.substr(1));
  return answer.substr(1);
}

}  // namespace palpate

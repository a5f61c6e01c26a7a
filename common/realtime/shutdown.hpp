#pragma once
#include <stdexcept>
#include <string>

namespace palpate {

/// Turns SIGINT, SIGTERM and, unless it is ignored, SIGHUP into a flag that loops look at; a second Ctrl-C ends the
/// process at once with status 130. Signals from the parent process do not count for that: a launcher passes
/// Ctrl-C on, which its children have had from the terminal already. Call once at the start of main. SIGPIPE is
/// ignored, so that a closed pipe is an error and not a death.
void catch_shutdown_signals();

/// True after one of them or request_shutdown().
bool shutdown_requested();

/// Asks all loops of this process to end; safe in any thread.
void request_shutdown();

/// What a command throws that one of the signals kept from its end; the program then ends with kInterruptedStatus.
struct Interrupted : std::runtime_error {
  explicit Interrupted(const std::string& said = "stopped before its end") : std::runtime_error(said) {}
};
constexpr int kInterruptedStatus = 130;  ///< as a shell says of Ctrl-C

/// Throws Interrupted after one of the signals.
void stop_if_interrupted();

/// For tests, and for programs that run loops one after the other.
void clear_shutdown();

}  // namespace palpate

#include "common/realtime/shutdown.hpp"

#include <signal.h>
#include <unistd.h>

#include <atomic>

namespace palpate {
namespace {

std::atomic<bool> requested{false};
std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int signal, siginfo_t* info, void*) {
  requested = true;
  const bool from_launcher = info->si_code == SI_USER && info->si_pid == getppid();
  if (signal == SIGINT && !from_launcher && interrupted.exchange(true)) _exit(kInterruptedStatus);
}

}  // namespace

void catch_shutdown_signals() {
  struct sigaction action {};
  action.sa_sigaction = on_signal;
  action.sa_flags = SA_SIGINFO;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before {};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup means it
  signal(SIGPIPE, SIG_IGN);
}

bool shutdown_requested() {
  return requested.load(std::memory_order_relaxed);
}

void request_shutdown() {
  requested = true;
}

void stop_if_interrupted() {
  if (shutdown_requested()) throw Interrupted();
}

void clear_shutdown() {
  requested = false;
  interrupted = false;
}

}  // namespace palpate

#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace palpate {

/// What a loop asks of the operating system.
struct RealtimeSettings {
  int priority = 80;        ///< SCHED_FIFO priority 1..99 of the calling thread; 0: leave the scheduler alone
  bool lock_memory = true;  ///< keep all pages of the process in memory
  int core = -1;            ///< pin the calling thread to this core; -1: any
};

struct RealtimeGrant {
  bool scheduler = false, memory = false, core = false;
  std::vector<std::string> sentences;  ///< one per request: what was granted, or not and why; for the operator
};

/// Applies the settings to the calling thread (memory: to the process). Never throws: a loop runs without,
/// only worse.
RealtimeGrant request_realtime(const RealtimeSettings& settings);

/// Back to the normal scheduler: for threads that a realtime thread starts, which would inherit its priority.
void leave_realtime();

/// Lets the calling thread, and those that it starts from then on, come before what is not realtime, as far as it is
/// permitted. For what brings the newest state, of which there may be any amount: the kernel stops all realtime threads
/// where they leave a core nothing.
void favour_thread();

/// Threads that the process starts from here on have stacks of 1 MiB in place of 8: where memory is locked, all of a
/// stack is resident. Call before there are threads.
void use_small_stacks();

/// Takes so much heap for the calling thread and gives none back: a loop that allocates within it makes no system call,
/// in which it would wait for whatever thread has the kernel change the process's memory. Call before memory is locked.
void keep_heap(std::size_t bytes);

/// Touches 256 KiB of the calling thread's stack, so that the first steps meet no page fault. Call before the
/// loop.
void prefault_stack();

}  // namespace palpate

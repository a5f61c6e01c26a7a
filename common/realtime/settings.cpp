#include "common/realtime/settings.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace palpate {
namespace {

constexpr int kFavoured = -15;            // nice value
constexpr int kLargestInHeap = 32 << 20;  // [bytes] the most that glibc permits; larger blocks are mapped

const char* reason(int error) {
  return error == EPERM ? "not permitted, grant CAP_SYS_NICE or an rtprio limit" : std::strerror(error);
}

std::string ask_scheduler(int priority, bool& granted) {
  sched_param parameter{};
  parameter.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
  granted = error == 0;
  return granted ? fmt::format("realtime scheduling: FIFO priority {}", priority)
                 : fmt::format("realtime scheduling: normal priority ({})", reason(error));
}

std::string ask_memory(bool& granted) {
  // What is mapped later is locked page by page as it is touched: at once, that holds up all who have memory mapped.
  granted = mlockall(MCL_CURRENT) == 0 && mlockall(MCL_FUTURE | MCL_ONFAULT) == 0;
  if (granted) return "memory: locked";
  const int error = errno;
  const bool limit = error == ENOMEM || error == EPERM;
  return fmt::format("memory: not locked ({})",
                     limit ? "not permitted, raise the memlock limit" : std::strerror(error));
}

std::string ask_core(int core, bool& granted) {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (core < CPU_SETSIZE) CPU_SET(static_cast<unsigned>(core), &set);
  const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
  granted = error == 0;
  return granted ? fmt::format("core: pinned to {}", core)
                 : fmt::format("core: not pinned to {} ({})", core, std::strerror(error));
}

}  // namespace

RealtimeGrant request_realtime(const RealtimeSettings& settings) {
  RealtimeGrant grant;
  if (settings.priority > 0) grant.sentences.push_back(ask_scheduler(settings.priority, grant.scheduler));
  if (settings.lock_memory) grant.sentences.push_back(ask_memory(grant.memory));
  if (settings.core >= 0) grant.sentences.push_back(ask_core(settings.core, grant.core));
  return grant;
}

void leave_realtime() {
  const sched_param parameter{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &parameter);
}

void favour_thread() {
  setpriority(PRIO_PROCESS, 0, kFavoured);
}

void use_small_stacks() {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, 1 << 20);
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
}

void keep_heap(std::size_t bytes) {
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_THRESHOLD, kLargestInHeap);
  void* volatile room = std::malloc(bytes);
  std::free(room);
}

void prefault_stack() {
  volatile unsigned char page[256 * 1024];
  for (std::size_t i = 0; i < sizeof page; i += 4096) page[i] = 0;
}

}  // namespace palpate

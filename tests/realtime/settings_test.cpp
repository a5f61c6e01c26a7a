#include "common/realtime/settings.hpp"

#include <gtest/gtest.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <thread>

namespace palpate {
namespace {

int current_policy() {
  int policy = 0;
  sched_param parameter;
  pthread_getschedparam(pthread_self(), &policy, &parameter);
  return policy;
}

TEST(RealtimeSettings, SaysWhatWasGrantedAndGrantsWhatItSays) {
  std::thread([] {
    const RealtimeGrant grant = request_realtime({.priority = 10, .lock_memory = true, .core = 0});
    ASSERT_EQ(grant.sentences.size(), 3u);
    EXPECT_EQ(grant.scheduler, current_policy() == SCHED_FIFO);
    EXPECT_EQ(grant.sentences[0].find("FIFO priority 10") != std::string::npos, grant.scheduler);
    EXPECT_EQ(grant.sentences[1] == "memory: locked", grant.memory);
    if (grant.core) {
      EXPECT_EQ(sched_getcpu(), 0);
    }
    leave_realtime();
    EXPECT_EQ(current_policy(), SCHED_OTHER);
  }).join();
  munlockall();
}

TEST(RealtimeSettings, ACoreThatDoesNotExistIsSaidAndNotFatal) {
  const RealtimeGrant grant = request_realtime({.priority = 0, .lock_memory = false, .core = 5000});
  EXPECT_FALSE(grant.core);
  ASSERT_EQ(grant.sentences.size(), 1u);
  EXPECT_NE(grant.sentences[0].find("not pinned to 5000"), std::string::npos);
}

TEST(RealtimeSettings, NothingAskedMeansNothingDone) {
  const int policy = current_policy();
  EXPECT_TRUE(request_realtime({.priority = 0, .lock_memory = false, .core = -1}).sentences.empty());
  EXPECT_EQ(current_policy(), policy);
  prefault_stack();
}

TEST(RealtimeSettings, WhatIsAllocatedWithinAKeptHeapAsksTheSystemForNothing) {
  keep_heap(16 << 20);
  const struct mallinfo2 before = mallinfo2();
  for (const std::size_t bytes : {100'000u, 1'000'000u, 12'000'000u, 300'000u}) {
    void* volatile block = std::malloc(bytes);
    EXPECT_EQ(mallinfo2().arena, before.arena) << bytes;
    EXPECT_EQ(mallinfo2().hblks, before.hblks) << bytes << ", mapped";
    std::free(block);
    EXPECT_EQ(mallinfo2().arena, before.arena) << bytes << " given back";
  }
}

TEST(RealtimeSettings, AFavouredThreadStartsFavouredOnes) {
  std::thread([] {
    const int before = getpriority(PRIO_PROCESS, 0);
    favour_thread();
    const int favoured = getpriority(PRIO_PROCESS, 0);  // or as before, where it is not permitted
    EXPECT_TRUE(favoured != before || geteuid() != 0);
    std::thread([&] { EXPECT_EQ(getpriority(PRIO_PROCESS, 0), favoured); }).join();
  }).join();
}

}  // namespace
}  // namespace palpate

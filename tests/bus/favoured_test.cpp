#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>

#include "common/bus/dds_bus.hpp"
#include "common/realtime/settings.hpp"
#include "tests/bus/domain.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

std::set<std::filesystem::path> threads() {
  std::set<std::filesystem::path> found;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) found.insert(thread.path());
  return found;
}

int nice_of(const std::filesystem::path& thread) {
  return getpriority(PRIO_PROCESS, static_cast<id_t>(std::stoul(thread.filename())));
}

TEST(FavouredBus, AllItsThreadsComeBeforeOthers) {
  int favoured = 0;  // or as before, where it is not permitted
  std::thread([&] {
    favour_thread();
    favoured = getpriority(PRIO_PROCESS, 0);
  }).join();
  const int before = getpriority(PRIO_PROCESS, 0);
  std::set<std::filesystem::path> others = threads();
  const auto bus = make_dds_bus({.domain = own_domain(), .favoured = true});
  int counted = 0;
  for (const auto& thread : threads()) {
    if (others.contains(thread)) continue;
    std::string name;
    std::getline(std::ifstream(thread / "comm"), name);
    EXPECT_EQ(nice_of(thread), favoured) << name;
    ++counted;
  }
  EXPECT_GE(counted, 4);
  EXPECT_EQ(getpriority(PRIO_PROCESS, 0), before) << "who asked for it";
}

}  // namespace
}  // namespace palpate

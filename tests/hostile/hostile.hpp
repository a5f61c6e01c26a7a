#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>

#include "tests/hostile/attacked_system.hpp"
#include "tests/realtime/host_watch.hpp"
#include "tests/sanitized.hpp"

namespace palpate::testing {

inline constexpr double kOnce = 5;  ///< [MB] by which a node may grow in a flood before another one is looked at
/// For pictures, and what nodes say: on a busy machine these yield first.
inline constexpr std::chrono::seconds kAfterFlood{15};

inline constexpr std::chrono::seconds kFound{60};  ///< in which a new writer has found all readers, with keys

/// A press of 10 N on the hovering tool, as the deform node would tell of it.
LocalContactModel press(std::uint64_t tool_run, std::uint64_t deform_run, std::uint64_t step, std::uint64_t seq);

/// One system for all attacks, since each starts from what the ones before have left; open to all, or with keys, which
/// the attacker has too.
class Hostile : public ::testing::TestWithParam<bool> {
 protected:
  static void SetUpTestSuite();
  static void TearDownTestSuite();
  void SetUp() override;
  /// Whatever was done: hands within their bounds, the loop in time, memory flat, and soon all as before.
  void TearDown() override;

  using Memory = std::map<std::string, double>;
  /// The node that grew most, and by how much.
  struct Growth {
    double mb;
    std::string node;
  };
  static Growth grown_since(const Memory& before);
  /// [MB] by which that node grows in a flood, send(k) for each k, behind a first one a third as long: what the
  /// allocator takes once for all floods is not what a name costs. The least of three floods where one is more than 5
  /// MB: what names cost, each costs.
  template <class Send>
  static double grown_in_flood(int many, Send&& send) {
    const auto flood = [&](int from, int to) {
      for (int k = from; k < to; ++k) {
        send(k);
        if (k % 300 == 0) system().watch(std::chrono::milliseconds(1));
      }
      system().watch(std::chrono::milliseconds(100));
    };
    flood(0, many / 3);
    double least = 1e9;
    for (int round = 0, begin = many / 3; round < 3 && least > kOnce; ++round, begin += many) {
      const Memory before = system().memory_mb();
      flood(begin, begin + many);
      const Growth grown = grown_since(before);
      fmt::print("{} grew by {:.1f} MB\n", grown.node, grown.mb);
      least = std::min(least, grown.mb);
    }
    return kSanitized ? 0 : least;
  }

  static AttackedSystem& system() { return *system_; }
  static HandWatch& hand() { return system_->hand(); }
  template <class M>
  static std::unique_ptr<HostileWriter<M>> writer(const Topic<M>& topic) {
    std::unique_ptr<HostileWriter<M>> made(new HostileWriter<M>(system_->attacker().writer(topic)));
    wait_until_it_reaches_all(*made);
    return made;
  }
  template <class M>
  static void wait_until_it_reaches_all(const HostileWriter<M>& made) {
    EXPECT_TRUE(system_->watch(kFound, [&] { return system_->attacker().reaches_all(made); }))
        << "an attack that is not heard";
    system_->watch(std::chrono::milliseconds(50));  // the readers find it too
  }
  static std::uint64_t haptic_run() { return hand().newest().run; }
  static std::uint64_t deform_run() { return system_->run_of("deform"); }
  static bool says(const std::string& node, const std::string& words) {
    return system_->said(node).find(words) != std::string::npos;
  }
  /// Of the loop since it began, [Hz], from what it says at its end.
  static double rate_hz(const nlohmann::json& said);

  bool ended_ = false;
  bool lied_to_ = false;  ///< somebody tells of tissue in the deform node's name
  bool misled_ = false;   ///< somebody moves the driven tool in its driver's name

 private:
  static bool is_in_free_air();
  void expect_guarded(int tool) const;

  static std::unique_ptr<HostWatch> host_;
  static std::unique_ptr<AttackedSystem> system_;
  static Memory memory_;
};

}  // namespace palpate::testing

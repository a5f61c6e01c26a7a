#pragma once
#include <fmt/format.h>

#include <cstdlib>
#include <memory>

#include "common/realtime/clock.hpp"
#include "tests/network/hosts_or_skip.hpp"
#include "tests/network/nodes.hpp"
#include "tests/network/observer.hpp"

namespace palpate::testing {

/// Tests that take many minutes in all run only where the environment asks for them.
inline bool long_tests() {
  return std::getenv("PALPATE_LONG_TESTS") != nullptr;
}

/// A scene with its tensors, two hosts, and what the programs said if the test fails.
template <class Scene, TwoHosts::Link link>
class NodesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    PALPATE_TWO_HOSTS_OR_SKIP(hosts_, link)
    precompute(scene_);
    nodes_ = std::make_unique<Nodes>(*hosts_, scene_);
    observer_ = std::make_unique<Observer>(*hosts_);
  }
  void TearDown() override {
    if (!HasFailure() || !nodes_) return;
    for (const char* name : {"haptic_node", "deform_node", "render_node", "palpate"})
      fmt::print("{}:\n{}\n", name, nodes_->said(name));
  }

  /// Waits until the surfaces show the run of the haptic node that is there now, in contact.
  bool joined(std::chrono::milliseconds limit = std::chrono::seconds(20)) {
    const std::uint64_t before = observer_->tool.step;
    return observer_->listen(limit, [&] {
      return observer_->tool.run != 0 && observer_->surface.run == observer_->tool.run &&
             observer_->surface.step > before;
    });
  }

  /// Listens until for a second and a half nothing more is removed.
  void wait_until_whole_cut() {
    std::size_t count = 0;
    while (observer_->listen(std::chrono::milliseconds(1500), [&] { return observer_->changes.size() > count; }))
      count = observer_->changes.size();
  }

  Scene scene_{::testing::UnitTest::GetInstance()->current_test_info()->name()};
  std::unique_ptr<TwoHosts> hosts_;
  std::unique_ptr<Nodes> nodes_;
  std::unique_ptr<Observer> observer_;
};

}  // namespace palpate::testing

#include <gtest/gtest.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>

#include "common/bus/memory_bus.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/spsc_ring.hpp"
#include "common/sim/step_record.hpp"
#include "haptic_node/local_feed.hpp"
#include "tests/haptic/local_models_for_tests.hpp"

// Every allocation of this process goes through these.
namespace {
std::atomic<bool> counting{false};
std::atomic<long> allocations{0};
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  if (counting.load(std::memory_order_relaxed)) ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t n, std::size_t size) {
  if (counting.load(std::memory_order_relaxed)) ++allocations;
  return __libc_calloc(n, size);
}
void* realloc(void* p, std::size_t size) {
  if (counting.load(std::memory_order_relaxed)) ++allocations;
  return __libc_realloc(p, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  if (counting.load(std::memory_order_relaxed)) ++allocations;
  return __libc_memalign(alignment, size);
}
}

namespace palpate {
namespace {

using testing::BlockScene;

/// A tick as the haptic loop runs it: step, record into the ring, checkpoint now and then.
class Ticks {
 public:
  explicit Ticks(const BlockScene& scene = BlockScene(2))
      : scene_(scene), haptic_(scene_.scene, scene_.archives), ring_(64), state_(haptic_.state_size()) {
    ring_.for_each_slot([this](StepRecord& slot) { prepare_record(haptic_, slot); });
    haptic_.start(input(0));
  }
  void run(int from, int to) {
    for (int i = from; i < to; ++i) {
      const auto dofs = input(i);
      if (i % 100 == 0) haptic_.save(state_);
      haptic_.step(dofs);
      if (StepRecord* record = ring_.begin_push()) {
        const std::array<DeviceSample, 2> samples{DeviceSample{dofs[0], 0}, DeviceSample{dofs[1], 0}};
        fill_record(haptic_, samples, i, now_ns(), *record);
        ring_.commit_push();
      }
      if (ring_.begin_pop()) ring_.commit_pop();
      touched_ += haptic_.force(0).norm() > 0;
      contacts_ += haptic_.law(0).contacts().size();
    }
  }
  long contacts() const { return contacts_; }
  long touched() const { return touched_; }

 private:
  std::array<ToolDofs, 2> input(int i) const {
    const double t = 1e-3 * i, z = 0.012 - 0.009 * std::sin(4 * t);
    return {tip_at(scene_.scene.tools[0], {-0.02 + 0.01 * t, 0.004 * std::sin(5 * t), z}, t),
            tip_at(scene_.scene.tools[1], {0.02, -0.01 + 0.01 * t, z - 0.001}, -t)};
  }
  BlockScene scene_;
  HapticStep haptic_;
  SpscRing<StepRecord> ring_;
  std::vector<std::uint8_t> state_;
  long contacts_ = 0, touched_ = 0;
};

/// The same with a body of moving tissue beside the block, whose models another thread has put where the loop finds
/// them.
class TicksOnMovingTissue {
 public:
  TicksOnMovingTissue()
      : scene_(1),
        haptic_(both(), archives()),
        models_(make_memory_bus(make_memory_network())),
        writer_(models_->writer(topics::local_contact_model)),
        feed_(*models_, haptic_, 5),
        ring_(64),
        state_(haptic_.state_size()) {
    feed_.follow(77);  // as empty_model() names it
    ring_.for_each_slot([this](StepRecord& slot) { prepare_record(haptic_, slot); });
    haptic_.start(input(0));
  }
  /// A model as the deform node would send it with the pose of step i: the other thread's part of the work.
  void send(int i) {
    const Eigen::Vector3d at = tip(i);
    LocalContactModel m =
        testing::empty_model(both_.tools[0], at, static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(i) + 1);
    testing::add_square(m, 0.001, 300);
    m.contacts.push_back(
        {1, 0, testing::plain(at - Eigen::Vector3d(0, 0, 0.008)), {0, 0, -1}, {0, 0, -0.5}, testing::isotropic(300)});
    for (LocalNode& n : m.nodes) n.body = 1;
    writer_->write(m);
    feed_.take();
  }
  void run(int from, int to) {
    for (int i = from; i < to; ++i) {
      const auto dofs = input(i);
      feed_.give(haptic_);
      if (i % 100 == 0) haptic_.save(state_);
      haptic_.step(dofs);
      if (StepRecord* record = ring_.begin_push()) {
        fill_record(haptic_, std::array{DeviceSample{dofs[0], 0}}, i, now_ns(), *record);
        used_ += record->of_tool[0].model_seq != 0;
        ring_.commit_push();
      }
      if (ring_.begin_pop()) ring_.commit_pop();
      felt_ += haptic_.force(0).norm() > 0;
    }
  }
  long felt() const { return felt_; }
  long used() const { return used_; }

 private:
  static Eigen::Vector3d tip(int i) { return {0.0001 * i / 10, 0, 0.012 - 0.009 * std::sin(4e-3 * i)}; }
  std::array<ToolDofs, 1> input(int i) const { return {tip_at(both_.tools[0], tip(i))}; }
  const Scene& both() {
    both_ = scene_.scene;
    both_.bodies.push_back(testing::moving_block_scene(0.008).bodies[0]);
    return both_;
  }
  const std::vector<Archive>& archives() {
    archives_ = scene_.archives;
    archives_.emplace_back();
    return archives_;
  }
  BlockScene scene_;
  Scene both_;
  std::vector<Archive> archives_;
  HapticStep haptic_;
  std::unique_ptr<Bus> models_;
  std::unique_ptr<Writer<LocalContactModel>> writer_;
  LocalFeed feed_;
  SpscRing<StepRecord> ring_;
  std::vector<std::uint8_t> state_;
  long felt_ = 0, used_ = 0;
};

TEST(NoSyscall, TheCountersCount) {
  counting = true;
  void* volatile first = std::malloc(10);
  int* volatile second = new int(3);
  counting = false;
  std::free(first);
  delete second;
  EXPECT_GE(allocations.exchange(0), 2);
}

TEST(NoSyscall, TheHapticStepAllocatesNothing) {
  Ticks ticks;
  ticks.run(1, 10);
  counting = true;
  ticks.run(10, 2000);
  counting = false;
  EXPECT_EQ(allocations.exchange(0), 0);
  EXPECT_GT(ticks.contacts(), 100) << "the tools must touch for this to mean anything";
}

TEST(NoSyscall, TheStepOfABodyThatIsCorrectedFromPlaceToPlaceAllocatesNothing) {
  for (const ContactRule rule : {ContactRule::barycentric, ContactRule::patch}) {
    BlockScene scene(2);
    scene.scene.contact.rule = rule;
    std::get<QuasiStaticSpec>(scene.scene.bodies[0]).nonlinear = Nonlinear{NeoHookeanLaw{}};
    scene.archives[0].presses = {{{-0.02, 0, 0}, 0.004, {{0.1, 0.11}, {1, 1.3}}, {{1e-4, 1.1e-4}, {1e-3, 1.2e-3}}},
                                 {{0.02, 0, 0}, 0.004, {{0.1, 0.1}, {1, 0.9}}, {{1e-4, 1e-4}}}};
    Ticks ticks(scene);
    ticks.run(1, 10);
    counting = true;
    ticks.run(10, 2000);
    counting = false;
    EXPECT_EQ(allocations.exchange(0), 0) << word_of(rule);
    EXPECT_GT(ticks.touched(), 100) << word_of(rule);
  }
}

TEST(NoSyscall, TheHapticStepOnMovingTissueAllocatesNothing) {
  TicksOnMovingTissue ticks;
  ticks.run(1, 10);
  for (int i = 10; i < 2000; i += 5) {
    ticks.send(i);
    counting = true;
    ticks.run(i, i + 5);
    counting = false;
  }
  EXPECT_EQ(allocations.exchange(0), 0);
  EXPECT_GT(ticks.felt(), 500);
  EXPECT_GT(ticks.used(), 1900);
}

/// From here on any system call but exit kills the process: no I/O, no sleeping lock, no memory from the system.
void forbid_system_calls() {
  sock_filter filter[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_exit, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
  };
  const sock_fprog program{4, filter};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0)
    _exit(77);
}

template <class Work>
int status_without_system_calls(Work&& work) {
  const pid_t child = fork();
  if (child == 0) {
    forbid_system_calls();
    work();
    syscall(SYS_exit, 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(NoSyscall, TheHapticStepMakesNoSystemCall) {
  Ticks ticks;
  ticks.run(1, 10);
  const int forbidden = status_without_system_calls([] { (void)!write(2, "", 0); });
  if (WIFEXITED(forbidden) && WEXITSTATUS(forbidden) == 77)
    GTEST_SKIP() << "this kernel does not grant seccomp filters";
  ASSERT_TRUE(WIFSIGNALED(forbidden)) << "a system call must kill the child, or the test below proves nothing";
  const int status = status_without_system_calls([&] { ticks.run(10, 2000); });
  EXPECT_TRUE(WIFEXITED(status)) << "killed by signal " << (WIFSIGNALED(status) ? WTERMSIG(status) : 0);

  TicksOnMovingTissue moving;
  moving.run(1, 10);
  moving.send(10);
  const int moving_status = status_without_system_calls([&] { moving.run(10, 600); });
  EXPECT_TRUE(WIFEXITED(moving_status)) << "killed by signal "
                                        << (WIFSIGNALED(moving_status) ? WTERMSIG(moving_status) : 0);
}

}  // namespace
}  // namespace palpate

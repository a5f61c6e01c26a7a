#include "haptic_node/haptic_loop.hpp"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include "common/log/log.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/settings.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/sim/leaving.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kRingSlots = 256;  // a quarter of a second in which the publisher may be kept from running
constexpr std::size_t kHeap = 16 << 20;  // [bytes] for messages that are kept until all have had them
constexpr int kLoopPriority = 80, kPublisherPriority = 60;

}  // namespace

HapticLoop::HapticLoop(HapticStep& haptic, std::vector<std::unique_ptr<Device>>& devices, Bus& bus, Presence& presence,
                       std::uint64_t run, std::string code_path)
    : haptic_(haptic),
      bus_(bus),
      devices_(devices),
      presence_(presence),
      publisher_(bus, haptic, run),
      clock_(bus, presence.node()),
      link_(bus),
      bus_devices_(bus, devices),
      local_feed_(bus, haptic, run),
      keyframe_interval_(static_cast<std::uint64_t>(std::lround(1 / haptic.dt()))),
      samples_(haptic.tools()),
      dofs_(haptic.tools()),
      ring_(kRingSlots) {
  for (int t = 0; t < haptic.tools(); ++t) guards_.emplace_back(haptic.rig(t).motion_limits(), haptic.dt());
  ring_.for_each_slot([&](StepRecord& slot) { prepare_record(haptic, slot); });
  keyframe_.dt = haptic.dt();
  keyframe_.code_path = std::move(code_path);
  keyframe_.state.resize(haptic.state_size());
}

HapticLoop::~HapticLoop() = default;

bool HapticLoop::is_over(double time, double seconds) const {
  if (shutdown_requested() || gives_way_.load(std::memory_order_relaxed) || (seconds > 0 && time >= seconds))
    return true;
  return std::ranges::all_of(devices_, [&](const auto& device) { return device->finished(time); });
}

bool HapticLoop::pushes() const {
  for (int t = 0; t < haptic_.tools(); ++t)
    if (!haptic_.force(t).isZero(0) || !haptic_.torque(t).isZero(0) || haptic_.grip_torque(t) != 0) return true;
  return false;
}

const LoopReport& HapticLoop::run(double seconds) {
  std::jthread publisher([this] { publish_loop(); });
  std::jthread pump;
  if (bus_devices_.needed() || local_feed_.needed())
    pump = std::jthread([this](const std::stop_token& stop) {
      favour_thread();
      while (!stop.stop_requested()) {
        std::this_thread::sleep_for(250us);
        if (bus_devices_.needed()) bus_devices_.take();
        if (local_feed_.needed()) local_feed_.take();
      }
    });
  prefault_stack();
  for (const std::string& said : request_realtime({.priority = kLoopPriority}).sentences) log_info(said);

  const std::int64_t begin = now_ns();
  PeriodicTimer timer(1 / haptic_.dt());
  for (double end = 0;;) {
    const double time = static_cast<double>(timer.wait()) * haptic_.dt();
    if (!leaves_ && is_over(time, seconds)) leaves_ = true, end = time;
    if (leaves_ && (!pushes() || time >= end + kMaxLeaving)) break;
    tick(time);
    wake_.release();
    shown_missed_.store(timer.statistics().skipped, std::memory_order_relaxed);
  }
  report_.seconds = 1e-9 * static_cast<double>(now_ns() - begin);
  report_.ticks = step_;
  report_.period = timer.statistics();
  report_.refused_samples = refused_samples();
  report_.followed_samples = shown_followed_.load(std::memory_order_relaxed);
  report_.refused_models = local_feed_.refused();
  report_.implausible_models = local_feed_.implausible();
  report_.refused_messages = bus_.refused();
  over_.store(true);
  wake_.release();
  publisher.join();
  report_.behind = pace_.looks_behind();
  if (!lost_claim_.empty()) throw std::runtime_error(lost_claim_);
  return report_;
}

void HapticLoop::tick(double time) {
  const std::int64_t sense = now_ns();
  for (std::size_t t = 0; t < devices_.size(); ++t) {
    samples_[t] = devices_[t]->read(time);
    dofs_[t] = guards_[t].follow(samples_[t].dofs, samples_[t].seq);
    if (leaves_) dofs_[t].silent = true;  // the force fades, and a replay does the same
    samples_[t].dofs = dofs_[t];
  }
  local_feed_.give(haptic_);
  if (step_ % keyframe_interval_ == 0) checkpoint();
  haptic_.step(dofs_);
  for (int t = 0; t < haptic_.tools(); ++t)
    devices_[t]->render({haptic_.force(t), haptic_.torque(t)}, haptic_.grip_torque(t));

  const std::int64_t push_begin = now_ns();
  if (StepRecord* record = ring_.begin_push()) {
    fill_record(haptic_, samples_, step_, sense, *record);
    record->pushed_ns = push_begin;
    ring_.commit_push();
  } else {
    shown_dropped_.store(++report_.dropped, std::memory_order_relaxed);
  }
  ++step_;
  const std::int64_t end = now_ns();
  report_.push.record(end - push_begin);
  report_.step.record(end - sense);
  std::uint32_t flags = 0;
  for (int t = 0; t < haptic_.tools(); ++t) {
    report_.max_force = std::max(report_.max_force, haptic_.force(t).norm());
    flags |= haptic_.flags(t);
  }
  count(leaves_ ? flags & ~kOfLeaving : flags);
  report_.min_energy = std::min(report_.min_energy, haptic_.energy());
  std::uint64_t refused = 0, followed = 0;
  for (const MotionGuard& guard : guards_) refused += guard.refused(), followed += guard.followed();
  shown_refused_.store(refused, std::memory_order_relaxed);
  shown_followed_.store(followed, std::memory_order_relaxed);
  shown_ticks_.store(step_, std::memory_order_relaxed);
}

void HapticLoop::count(std::uint32_t flags) {
  report_.limited += (flags & (force_limited | slew_limited)) != 0;
  report_.force_limited += (flags & force_limited) != 0;
  report_.slew_limited += (flags & slew_limited) != 0;
  report_.regularised += (flags & regularised) != 0;
  report_.faults += (flags & fault) != 0;
  report_.damped += (flags & passivity_limited) != 0;
  report_.silent += (flags & silent_device) != 0;
  report_.stale += (flags & stale_model) != 0;
  report_.late += (flags & late_tissue) != 0;
  report_.implausible += (flags & implausible_force) != 0;
  shown_flags_.fetch_or(flags, std::memory_order_relaxed);
}

// Once a second the state is saved for replay. The factor is forgotten in that step whether or not the publisher has
// room for it, since a replay does the same by the step's number alone.
void HapticLoop::checkpoint() {
  if (keyframe_full_.load(std::memory_order_acquire)) {
    haptic_.forget_factors();
    return;
  }
  keyframe_.step = step_;
  haptic_.save(keyframe_.state);
  keyframe_full_.store(true, std::memory_order_release);
}

void HapticLoop::publish_loop() {
  keep_heap(kHeap);
  request_realtime({.priority = kPublisherPriority, .lock_memory = false});
  while (!over_.load()) {
    (void)wake_.try_acquire_for(20ms);
    clock_.answer();
    drain();
    report_status(now_ns());
    if (topology_) topology_->take();
  }
  drain();
  say_interventions();
  publisher_.finish();
}

void HapticLoop::drain() {
  while (const StepRecord* record = ring_.begin_pop()) {
    if (keyframe_full_.load(std::memory_order_acquire) && keyframe_.step <= record->step) {
      publisher_.publish(keyframe_);
      keyframe_full_.store(false, std::memory_order_release);
    }
    publisher_.publish(*record);
    report_.wire.record(now_ns() - record->pushed_ns);
    ring_.commit_pop();
  }
}

void HapticLoop::report_status(std::int64_t now) {
  check_peers();
  if (now - last_status_ns_ < 1'000'000'000) return;
  for (const std::string& said : link_.look(presence_, now)) log_warning(said);
  const std::uint64_t ticks = shown_ticks_.load(std::memory_order_relaxed);
  const double rate = last_status_ns_ == 0 ? 0
                                           : 1e9 * static_cast<double>(ticks - last_status_ticks_) /
                                                 static_cast<double>(now - last_status_ns_);
  const std::uint64_t missed = shown_missed_.load(std::memory_order_relaxed);
  say_interventions();
  pace_.look(ticks, missed);
  if (!pace_.news().empty()) log_warning(pace_.news());
  const std::string between = told_.status().empty() || pace_.status().empty() ? "" : "; ";
  presence_.announce(rate, ticks, missed, 0, 0, told_.status() + between + pace_.status());
  last_status_ns_ = now;
  last_status_ticks_ = ticks;
}

void HapticLoop::say_interventions() {
  told_.look({.flags = shown_flags_.exchange(0, std::memory_order_relaxed),
              .refused_samples = refused_samples(),
              .followed = shown_followed_.load(std::memory_order_relaxed),
              .refused_models = local_feed_.refused(),
              .implausible_models = local_feed_.implausible()});
  for (const std::string& said : told_.news()) log_warning(said);
  if (told_of_dropped_ || shown_dropped_.load(std::memory_order_relaxed) == 0) return;
  told_of_dropped_ = true;
  log_warning("steps are told to nobody, and a log lacks them: the thread that publishes them has no processor");
}

std::uint64_t HapticLoop::refused_samples() const {
  return bus_devices_.refused() + shown_refused_.load(std::memory_order_relaxed);
}

void HapticLoop::check_peers() {
  for (const std::string& said : presence_.watch()) log_info(said);
  if (lost_claim_.empty() && !(lost_claim_ = presence_.lost_claim()).empty())
    gives_way_.store(true, std::memory_order_relaxed);
  if (const Presence::Peer* deform = presence_.holder("deform")) local_feed_.follow(deform->status.run);
}

}  // namespace palpate

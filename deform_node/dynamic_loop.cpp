#include "deform_node/dynamic_loop.hpp"

#include <fmt/format.h>

#include "common/log/log.hpp"
#include "common/models/marked_to_resect.hpp"
#include "common/models/moving/tissue_steps.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/core_share.hpp"
#include "common/realtime/settings.hpp"
#include "common/realtime/shutdown.hpp"

namespace palpate {
namespace {

constexpr std::uint64_t kReminderTicks = 64;
constexpr double kSettlingShare = 0.8;   // of a tick's time
constexpr int kLoopPriority = 50;        // below the haptic loop and what it publishes, above the picture
constexpr std::size_t kHeap = 16 << 20;  // [bytes] for messages as they are written

std::size_t tetrahedra_of(const DynamicWorld& world) {
  std::size_t sum = 0;
  for (int i = 0; i < world.organs(); ++i) sum += world.organ(i).mesh().tetrahedra.size();
  return sum;
}

}  // namespace

DynamicLoop::DynamicLoop(DynamicWorld& world, LocalModels& local_models, Deformer& deformer, Bus& bus,
                         Presence& presence, const Scene& scene, std::uint64_t run, std::string code_path)
    : bus_(bus),
      world_(world),
      deformer_(deformer),
      presence_(presence),
      clock_(bus, presence.node()),
      link_(bus),
      run_(run),
      visual_hz_(scene.rates.visual_hz),
      local_models_(local_models),
      feed_(bus, presence, deformer),
      surfaces_(bus, deformer),
      range_(scene, deformer),
      tools_(bus.reader(topics::tool_state)),
      changes_(bus.writer(topics::topology_change)),
      models_(bus.writer(topics::local_contact_model)),
      steps_(bus.writer(topics::deform_step)),
      keyframes_(bus.writer(topics::deform_keyframe)),
      change_seq_(scene.bodies.size(), 0),
      model_(scene.tools.size()),
      earlier_(bus, {world.bodies().begin(), world.bodies().end()}, tetrahedra_of(world), now_ns()) {
  presence_.set_clock(&clock_);
  keyframe_.code_path = std::move(code_path);
  for (const Body& body : scene.bodies)
    moves_.push_back(owner_of(body) == Owner::deform_node), names_.push_back(name_of(body));
  for (int i = 0; i < world.organs(); ++i)
    if (const Box* marked = marked_to_resect(scene.bodies[world.bodies()[i]]))
      resections_.emplace(world.bodies()[i], Resection(*marked, world.organ(i).mesh()));
}

void DynamicLoop::take_tools() {
  while (const auto state = tools_->take()) {
    const bool good = presence_.accepts(state->run) && world_.take(*state);
    late_ |= good && !heard_ && state->step > world_.keyframe_interval();
    heard_ |= good;
    if (good) tools_from_ = tools_->taken_from();
    report_.refused += !good;
  }
  if (!tools_->lasts(tools_from_))
    for (int t = 0; t < world_.tools(); ++t) world_.leave(t);
}

void DynamicLoop::take_earlier_cuts() {
  if (!earlier_.in_time())
    log_warning("not every node has told what had been cut before: what those know that have is taken");
  for (int i = 0; i < world_.organs(); ++i) {
    const int body = world_.bodies()[i];
    const HeldTopology* held = whole_ ? nullptr : earlier_.of(body);
    if (held && world_.organ(i).begin_without(held->removed))
      log_info(fmt::format("body '{}': {} tetrahedra had gone before, by {}", names_[body],
                           world_.organ(i).removed().size(), held->node));
  }
}

void DynamicLoop::begin_tissue(std::int64_t now) {
  if (!earlier_.complete(presence_, now)) return;
  presence_.claim("the moving tissue of this scene");
  take_earlier_cuts();
  phase_ = late_ || earlier_.another_had_them() ? Phase::settling : Phase::moving;
  if (phase_ == Phase::settling) log_info("the tools are there already: the tissue comes to rest around them first");
  if (phase_ == Phase::moving) tell_begin();
}

// As much as fits into one tick's time, so that the newest states and the house are not kept waiting.
void DynamicLoop::settle(std::int64_t now) {
  const auto until = now + static_cast<std::int64_t>(kSettlingShare * 1e9 * world_.dt());
  bool over = false;
  do {
    over = world_.settle();
    for (int i = 0; i < world_.organs(); ++i) count(i);
  } while (!over && now_ns() < until);
  if (!over) return;
  phase_ = Phase::moving;
  tell_begin();
}

// The first message of a run for each body: all that is gone.
void DynamicLoop::tell_begin() {
  for (int i = 0; i < world_.organs(); ++i) publish_change(i, gone_before, world_.organ(i).removed());
}

// Late is what the tissue's time lacks when a tick begins: those that were left out, and what this one came after its
// time.
void DynamicLoop::tick(std::int64_t due_ns) {
  feed_.take();
  if (world_.ticks() == 0) first_due_ns_ = due_ns;
  if (world_.ticks() % world_.keyframe_interval() == 0) {
    keyframe_.run = run_;
    ++keyframe_.seq;
    keyframe_.tick = world_.ticks();
    stamp(time_, keyframe_);
    keyframe_.state = world_.save();
    keyframes_->write(keyframe_);
  }
  const std::int64_t begin = now_ns();
  const std::uint64_t number = world_.ticks();
  time_.late_ns = std::max<std::int64_t>(begin - first_due_ns_ - world_.time_ns(), 0);
  world_.tick();
  time_.tissue_ns = world_.time_ns();
  report_.tick.record(now_ns() - begin);
  report_.late_ns = time_.late_ns;

  step_.run = run_;
  ++step_.seq;
  step_.tick = number;
  stamp(time_, step_);
  step_.consumed.clear();
  for (int t = 0; t < world_.tools(); ++t) {
    const ToolState& tool = world_.tool(t).consumed();
    if (world_.tool(t).has_left()) step_.consumed.push_back({static_cast<std::uint32_t>(t), tool.run, tool_left});
    if (world_.tool(t).consumed_anew()) step_.consumed.push_back({static_cast<std::uint32_t>(t), tool.run, tool.step});
  }
  step_.hash = world_.hash();
  steps_->write(step_);
  publish_changes();
  publish_models();
}

void DynamicLoop::publish_change(int organ, RemovalCause cause, const std::vector<int>& removed) {
  const int body = world_.bodies()[organ];
  TopologyChange m{.body = static_cast<std::uint32_t>(body), .run = run_, .seq = ++change_seq_[body], .cause = cause};
  stamp(time_, m);
  m.removed.assign(removed.begin(), removed.end());
  changes_->write(m);
}

void DynamicLoop::publish_changes() {
  for (int i = 0; i < world_.organs(); ++i) {
    for (const DynamicOrgan::Change& change : world_.organ(i).changes())
      publish_change(i, change.cause, change.removed);
    count(i);
  }
}

void DynamicLoop::count(int organ) {
  const auto resection = resections_.find(world_.bodies()[organ]);
  for (const DynamicOrgan::Change& change : world_.organ(organ).changes()) {
    if (change.cause == RemovalCause::cut && resection != resections_.end()) resection->second.cut(change.removed);
    report_.cut += change.cause == RemovalCause::cut ? change.removed.size() : 0;
    report_.torn += change.cause == RemovalCause::torn ? change.removed.size() : 0;
    report_.fallen += change.cause == RemovalCause::fell_away ? change.removed.size() : 0;
  }
}

void DynamicLoop::publish_models() {
  local_models_.refresh();
  for (int t = 0; t < world_.tools(); ++t) {
    if (!world_.tool(t).follows()) continue;  // silence is understood, and its end as well
    LocalContactModel& m = model_[t];
    const bool was_near = !m.triangles.empty() || !m.contacts.empty();
    const bool near = local_models_.describe(t, m);
    // An empty one says that there is nothing near any more, and again from time to time, since it may be lost.
    const bool remind = m.seq > 0 && world_.ticks() % kReminderTicks == 0;
    if (!near && !was_near && !remind) continue;
    m.run = run_;
    ++m.seq;
    stamp(time_, m);
    models_->write(m);
  }
}

void DynamicLoop::publish_frames() {
  deformer_.deform();
  SurfacePublisher::Moment newest{deformer_.run(), deformer_.step(), deformer_.sense_ns()};
  for (int t = 0; t < world_.tools(); ++t) {
    const ToolState& s = world_.tool(t).consumed();
    if (s.sense_ns > newest.sense_ns) newest = {s.run, s.step, s.sense_ns};
  }
  for (int b = 0; b < deformer_.bodies(); ++b)
    if (!moves_[b])
      surfaces_.publish(b, {deformer_.shape(b).origin(), deformer_.surface(b).position, deformer_.surface(b).normal},
                        newest);
  SurfacePublisher::Moment of_tissue = newest;
  of_tissue.tissue = time_;
  for (int i = 0; i < world_.organs(); ++i) {
    world_.organ(i).shape(position_, normal_);
    surfaces_.publish(world_.bodies()[i], {world_.organ(i).origin(), position_, normal_}, of_tissue);
  }
  ++report_.frames;
  for (const std::string& said : range_.look(deformer_)) log_warning(said);
  if (newest.sense_ns == shown_sense_ns_) return;
  shown_sense_ns_ = newest.sense_ns;
  const std::int64_t latency = surfaces_.last_publish_ns() - clock_.to_own(newest.sense_ns);
  report_.latency.record(latency);
  recent_latency_.record(latency);
}

void DynamicLoop::keep_house(std::int64_t now) {
  for (const std::string& said : presence_.watch()) log_info(said);
  if (const std::string lost = presence_.lost_claim(); !lost.empty()) throw std::runtime_error(lost);
  for (const std::string& said : link_.look(presence_, now)) log_warning(said);
  feed_.watch_haptic(now);
  if (now - last_status_ns_ < kNsPerS) return;
  const double rate = last_status_ns_ == 0 ? 0
                                           : 1e9 * static_cast<double>(report_.ticks - last_ticks_) /
                                                 static_cast<double>(now - last_status_ns_);
  const Percentiles latency = percentiles_us(recent_latency_);
  pace_.look(report_.ticks, report_.period.skipped);
  if (!pace_.news().empty()) log_warning(pace_.news());
  const std::string silence = link_.silence("haptic", now), warning = silence.empty() ? pace_.status() : silence;
  presence_.announce(rate, report_.ticks, report_.period.skipped, latency.p50, latency.p99,
                     warning.empty() ? range_.warning() : warning);
  recent_latency_.clear();
  last_status_ns_ = now;
  last_ticks_ = report_.ticks;
}

const DynamicReport& DynamicLoop::run(double seconds) {
  keep_heap(kHeap);
  for (const std::string& said : request_realtime({.priority = kLoopPriority}).sentences) log_info(said);
  const std::int64_t begin = now_ns();
  const auto frame_ns = static_cast<std::int64_t>(1e9 / visual_hz_);
  PeriodicTimer timer(1 / world_.dt(), 0);
  CoreShare share(kTissueShare);
  std::int64_t next_frame = begin, next_house = begin, first_tick = begin;
  while (!shutdown_requested()) {
    timer.wait();
    const std::int64_t now = now_ns();
    if (seconds > 0 && 1e-9 * static_cast<double>(now - begin) >= seconds) break;
    clock_.follow();
    take_tools();
    if (heard_ && phase_ == Phase::waiting) begin_tissue(now);
    if (phase_ == Phase::settling) settle(now);
    if (phase_ == Phase::moving) {
      tick(timer.tick_time_ns());
      ++report_.ticks;
      report_.period.skipped = timer.statistics().skipped;
    } else {
      timer.reset_statistics();
      first_tick = now;
    }
    if (now >= next_frame) {
      publish_frames();
      next_frame = std::max(next_frame + frame_ns, now);
    }
    if (now >= next_house) {
      keep_house(now);
      next_house = now + 50'000'000;
    }
    if (const std::int64_t end = now_ns(), rest = share.rest(now, end); rest > 0) sleep_until_ns(end + rest);
  }
  report_.refused += feed_.refused() + bus_.refused();
  report_.period = timer.statistics();
  report_.behind = pace_.looks_behind();
  report_.seconds = 1e-9 * static_cast<double>(now_ns() - first_tick);
  return report_;
}

}  // namespace palpate

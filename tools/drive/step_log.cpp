#include "tools/drive/step_log.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <stdexcept>

#include "common/bus/recorder.hpp"
#include "common/kernels/code_path.hpp"
#include "common/realtime/clock.hpp"
#include "tools/logs/log_files.hpp"

namespace palpate::drive {
namespace {

constexpr std::uint64_t kRun = sim::Simulator::kRun;

LogHeader header_of(const Scene& scene, const LogClock& clock) {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  return {.scene_hash = scene_hash(scene),
          .scene = to_toml(scene),
          .schema = schema_text(),
          .version = PALPATE_VERSION,
          .code_path = code_path(),
          .host = host,
          .start_wall_ns = wall_ns(),
          .start_monotonic_ns = clock.start_ns};
}

std::vector<float> flat(std::span<const Eigen::Vector3f> vectors) {
  std::vector<float> numbers;
  numbers.reserve(3 * vectors.size());
  for (const Eigen::Vector3f& v : vectors) numbers.insert(numbers.end(), v.data(), v.data() + 3);
  return numbers;
}

}  // namespace

StepLog::StepLog(const std::filesystem::path& file, sim::Simulator& simulator)
    : file_(file),
      simulator_(simulator),
      keyframe_interval_(static_cast<std::uint64_t>(std::lround(1 / simulator.dt()))),
      surface_interval_(static_cast<std::uint64_t>(
          std::max(1l, std::lround(1 / (simulator.dt() * simulator.scene().rates.visual_hz))))),
      clock_{.start_ns = now_ns()},
      log_(file, header_of(simulator.scene(), clock_), WhenFull::wait),
      bus_(make_log_bus(log_, clock_)),
      haptic_(*bus_, simulator.haptic(), kRun),
      changes_(bus_->writer(topics::topology_change)),
      models_(bus_->writer(topics::local_contact_model)),
      steps_(bus_->writer(topics::deform_step)),
      keyframes_(bus_->writer(topics::deform_keyframe)),
      surfaces_(bus_->writer(topics::surface_state)),
      change_seq_(simulator.bodies(), 0) {
  const Scene& scene = simulator.scene();
  bus_->writer(topics::scene)
      ->write(
          {.run = kRun, .seq = 1, .scene_hash = scene_hash(scene), .text = to_toml(scene), .code_path = code_path()});
  for (const LogFile& file : files_for_log(scene)) log_.write(kFileChannel, clock_.start_ns, file);
  for (const int body : simulator.tissue().bodies())
    changes_->write(
        {.body = static_cast<std::uint32_t>(body), .run = kRun, .seq = ++change_seq_[body], .cause = gone_before});
}

void StepLog::before_step() {
  const std::uint64_t step = simulator_.steps();
  if (step % keyframe_interval_ != 0) return;
  HapticKeyframe haptic{.step = step, .dt = simulator_.dt(), .code_path = code_path()};
  haptic.state.resize(simulator_.haptic().state_size());
  simulator_.haptic().save(haptic.state);
  haptic_.publish(haptic);
  if (simulator_.tissue().organs() == 0) return;
  keyframes_->write({.run = kRun,
                     .seq = ++keyframe_seq_,
                     .tick = simulator_.tissue().ticks(),
                     .tissue_ns = simulator_.tissue().time_ns(),
                     .code_path = code_path(),
                     .state = simulator_.tissue().save()});
}

void StepLog::after_step() {
  clock_.now_ns = simulator_.record().sense_ns;
  haptic_.publish(simulator_.record());
  if (simulator_.tissue().organs() > 0) {
    write_tissue_step();
    write_changes();
  }
  if (simulator_.record().step % surface_interval_ == 0) write_surfaces();
}

void StepLog::write_tissue_step() {
  const DynamicWorld& tissue = simulator_.tissue();
  DeformStep step{.run = kRun,
                  .seq = tissue.ticks(),
                  .tick = tissue.ticks() - 1,
                  .tissue_ns = tissue.time_ns(),
                  .hash = tissue.hash()};
  for (int t = 0; t < tissue.tools(); ++t) {
    step.consumed.push_back({static_cast<std::uint32_t>(t), kRun, tissue.tool(t).consumed().step});
    models_->write(simulator_.local_model(t));
  }
  steps_->write(step);
}

void StepLog::write_changes() {
  for (const sim::ChangeView& change : simulator_.changes()) {
    TopologyChange m{.body = static_cast<std::uint32_t>(change.body),
                     .run = kRun,
                     .seq = ++change_seq_[change.body],
                     .cause = change.cause,
                     .tissue_ns = simulator_.tissue().time_ns()};
    m.removed.assign(change.removed.begin(), change.removed.end());
    changes_->write(m);
  }
}

void StepLog::write_surfaces() {
  const StepRecord& record = simulator_.record();
  const std::span<const int> moving = simulator_.tissue().bodies();
  ++surface_seq_;
  for (int b = 0; b < simulator_.bodies(); ++b) {
    const sim::SurfaceView shown = simulator_.surface(b);
    surfaces_->write({.body = static_cast<std::uint32_t>(b),
                      .run = kRun,
                      .seq = surface_seq_,
                      .step = record.step,
                      .sense_ns = record.sense_ns,
                      .tissue_ns = std::ranges::find(moving, b) == moving.end() ? 0 : simulator_.tissue().time_ns(),
                      .origin = {shown.origin.x(), shown.origin.y(), shown.origin.z()},
                      .position = flat(shown.position),
                      .normal = flat(shown.normal)});
  }
}

void StepLog::finish() {
  haptic_.finish();
  const LogStatus status = log_.finish();
  if (status.lost > 0) throw std::runtime_error(fmt::format("{}: {}", file_.string(), loss_text(status)));
}

}  // namespace palpate::drive

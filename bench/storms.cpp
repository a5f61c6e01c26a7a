// What does a hand feel when the deformation or the haptic node is killed at any moment and another one comes? In lock
// step, in the example scenes of moving tissue, against the undisturbed run with the same motion. Ends with status 1 if
// a death gave a hand more than a tenth over the undisturbed run's largest force, or more in a tick than its slew
// limit.
//   bench_storms [--quick] [TRIALS] [SCENE or SCENE_deform or SCENE_haptic]
//   bench_storms course SCENE deform|haptic FROM TO    the size of each tool's force, tick by tick, of one death
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <exception>
#include <random>
#include <stdexcept>

#include "bench/report.hpp"
#include "common/devices/device.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/scene.hpp"
#include "common/tool/motion_guard.hpp"
#include "tools/rig/two_nodes.hpp"

namespace {
using namespace palpate;

constexpr int kMaxTools = 4;
constexpr int kAfter = 4000;                                 // ticks that are watched once the node is back
constexpr double kTolerance = 1.1;                           // of the undisturbed run's largest force
constexpr int kShortest = 10, kLongest = 2000;               // ticks that the deformation node is away
constexpr int kHapticShortest = 300, kHapticLongest = 2500;  // likewise: it takes half a second to begin

enum class Victim { deform, haptic };

/// What the hands of a scene feel over some ticks.
struct Felt {
  int first = 0, end = 0, back = 0;  ///< ticks: when it dies, when one looks no longer, when another is there
  double largest[kMaxTools]{};       ///< [N]
  double rise = 0, change = 0;       ///< [N] in a tick: of the size, and of the vector, the tick of a death left out
  bool too_fast = false;             ///< a change beyond its tool's slew limit
};

/// A scene with what moves its tools, as the haptic node reads it.
class Motion {
 public:
  explicit Motion(const Scene& scene) : dt_(1 / scene.rates.haptic_hz) {
    devices_ = make_devices(scene.tools, scene.rates.haptic_hz);
    for (const Tool& tool : scene.tools) guards_.emplace_back(tool.motion, dt_);
    for (int k = 0; k == 0 || !over(k); ++k) add(k);
  }
  int ticks() const { return static_cast<int>(at_.size()); }
  std::span<const ToolDofs> at(int tick) const { return at_[std::min(tick, ticks() - 1)]; }

 private:
  bool over(int k) const {
    return std::ranges::all_of(devices_, [&](const auto& device) { return device->finished(k * dt_); });
  }
  void add(int k) {
    std::vector<ToolDofs> dofs;
    for (std::size_t t = 0; t < devices_.size(); ++t) {
      const DeviceSample sample = devices_[t]->read(k * dt_);
      dofs.push_back(k == 0 ? sample.dofs : guards_[t].follow(sample.dofs, sample.seq));
    }
    at_.push_back(std::move(dofs));
  }

  double dt_;
  std::vector<MotionGuard> guards_;
  std::vector<std::unique_ptr<Device>> devices_;
  std::vector<std::vector<ToolDofs>> at_;
};

class Hands {
 public:
  Hands(const TwoNodes& nodes, const Scene& scene) : nodes_(nodes), before_(scene.tools.size()) {
    for (const Tool& tool : scene.tools) max_change_.push_back(tool.max_force_rate / scene.rates.haptic_hz);
    see();
  }
  /// Looks at the forces of a tick; `counts`: its changes too.
  void look(Felt& felt, bool counts) {
    for (std::size_t t = 0; t < before_.size(); ++t) {
      const Eigen::Vector3d force = nodes_.force(static_cast<int>(t));
      felt.largest[t] = std::max(felt.largest[t], force.norm());
      if (!counts) continue;
      felt.rise = std::max(felt.rise, force.norm() - before_[t].norm());
      const double change = (force - before_[t]).norm();
      felt.change = std::max(felt.change, change);
      felt.too_fast |= change > max_change_[t] * (1 + 1e-9);
    }
    see();
  }

 private:
  void see() {
    for (std::size_t t = 0; t < before_.size(); ++t) before_[t] = nodes_.force(static_cast<int>(t));
  }
  const TwoNodes& nodes_;
  std::vector<Eigen::Vector3d> before_;
  std::vector<double> max_change_;  ///< [N] in a tick
};

/// One death, from here on.
Felt disturb(TwoNodes& nodes, const Motion& motion, const Scene& scene, Victim victim, int tick, int away) {
  Felt felt{.first = tick, .end = std::min(tick + away + kAfter, motion.ticks()), .back = tick + away};
  Hands hands(nodes, scene);
  victim == Victim::deform ? nodes.kill_tissue() : nodes.kill_haptic();
  for (int k = tick; k < felt.end; ++k) {
    if (k == felt.back) victim == Victim::deform ? nodes.restart_tissue() : nodes.restart_haptic(motion.at(k));
    nodes.step(motion.at(k));
    hands.look(felt, k != tick || victim == Victim::deform);
  }
  return felt;
}

/// In a process of its own, so that the run itself goes on undisturbed.
Felt disturb_a_copy(TwoNodes& nodes, const Motion& motion, const Scene& scene, Victim victim, int tick, int away) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child == 0) {
    const Felt felt = disturb(nodes, motion, scene, victim, tick, away);
    _exit(write(ends[1], &felt, sizeof felt) == sizeof felt ? 0 : 1);
  }
  close(ends[1]);
  Felt felt;
  const bool whole = read(ends[0], &felt, sizeof felt) == sizeof felt;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!whole || status != 0) throw std::runtime_error(fmt::format("the run that was disturbed at tick {} died", tick));
  return felt;
}

struct Storm {
  std::vector<Felt> felt;
  Felt whole;                ///< of the undisturbed run
  std::vector<int> changes;  ///< its ticks in which tissue was cut, tore or fell away

  /// What should have been cut while a node was away is not, and the tool meets it.
  bool missed(const Felt& felt) const {
    const auto first = std::ranges::lower_bound(changes, felt.first);
    return first != changes.end() && *first < felt.back;
  }
};

Storm storm(const Scene& scene, const std::vector<Archive>& archives, Victim victim, int trials) {
  const Motion motion(scene);
  std::mt19937 random(victim == Victim::deform ? 17 : 18);
  std::multimap<int, int> deaths;  // by tick, for so many ticks
  const bool deform = victim == Victim::deform;
  const double low = std::log(deform ? kShortest : kHapticShortest),
               high = std::log(deform ? kLongest : kHapticLongest);
  for (int i = 0; i < trials; ++i)
    deaths.emplace(std::uniform_int_distribution<int>(1, motion.ticks() - 1)(random),
                   static_cast<int>(std::exp(std::uniform_real_distribution<double>(low, high)(random))));
  TwoNodes nodes(scene, archives);
  nodes.start(motion.at(0));
  Storm all;
  Hands hands(nodes, scene);
  for (int k = 1; k < motion.ticks(); ++k) {
    for (auto [at, end] = deaths.equal_range(k); at != end; ++at)
      all.felt.push_back(disturb_a_copy(nodes, motion, scene, victim, k, at->second));
    nodes.step(motion.at(k));
    hands.look(all.whole, true);
    for (int i = 0; i < nodes.world().organs(); ++i)
      if (!nodes.world().organ(i).changes().empty()) all.changes.push_back(k);
  }
  return all;
}

/// The worst of some trials.
struct Worst {
  int trials = 0, over = 0, too_fast = 0;
  double force = 0, ratio = 0, rise = 0, change = 0;
  Felt of;  ///< that with the largest ratio

  void add(const Felt& felt, const Felt& undisturbed, int tools) {
    bool is_over = false;
    for (int t = 0; t < tools; ++t) {
      is_over |= felt.largest[t] > kTolerance * undisturbed.largest[t];
      force = std::max(force, felt.largest[t]);
      if (felt.largest[t] > ratio * undisturbed.largest[t]) ratio = felt.largest[t] / undisturbed.largest[t], of = felt;
    }
    ++trials;
    over += is_over;
    too_fast += felt.too_fast;
    rise = std::max(rise, felt.rise);
    change = std::max(change, felt.change);
  }
};

/// Says how many trials gave a hand more than they may.
int tell(const std::string& name, const Storm& storm, int tools) {
  const auto row = [&](const std::string& metric, double value, const char* unit) {
    bench::report("storms", name, metric, value, unit);
  };
  row("undisturbed_force", *std::max_element(storm.whole.largest, storm.whole.largest + tools), "N");
  row("undisturbed_rise", storm.whole.rise, "N/tick");
  row("undisturbed_change", storm.whole.change, "N/tick");
  Worst whole, missed;
  for (const Felt& felt : storm.felt) (storm.missed(felt) ? missed : whole).add(felt, storm.whole, tools);
  for (const auto& [worst, suffix] : {std::pair{&whole, ""}, {&missed, "_where_a_cut_was_missed"}}) {
    if (worst->trials == 0) continue;
    row(std::string("trials") + suffix, worst->trials, "1");
    row(std::string("force") + suffix, worst->force, "N");
    row(std::string("force_ratio") + suffix, worst->ratio, "1");
    row(std::string("over_a_tenth_more") + suffix, worst->over, "1");
    row(std::string("beyond_the_slew_limit") + suffix, worst->too_fast, "1");
    row(std::string("rise") + suffix, worst->rise, "N/tick");
    row(std::string("change") + suffix, worst->change, "N/tick");
    row(std::string("worst_from_tick") + suffix, worst->of.first, "1");
    row(std::string("worst_to_tick") + suffix, worst->of.back, "1");
  }
  return whole.over + whole.too_fast + missed.over + missed.too_fast;
}

std::string scene_file(const std::string& name) {
  return fmt::format("{}/{}.toml", PALPATE_SCENES, name);
}

/// A line a tick: its number, then the force [N] of each tool.
void print_course(const std::string& name, Victim victim, int from, int to) {
  const Scene scene = load_scene(scene_file(name));
  const Motion motion(scene);
  TwoNodes nodes(scene, load_or_precompute(scene, ArchivePart::surface));
  nodes.start(motion.at(0));
  for (int k = 1; k < motion.ticks(); ++k) {
    if (k == from) victim == Victim::deform ? nodes.kill_tissue() : nodes.kill_haptic();
    if (k == to) victim == Victim::deform ? nodes.restart_tissue() : nodes.restart_haptic(motion.at(k));
    nodes.step(motion.at(k));
    fmt::print("{}", k);
    for (std::size_t t = 0; t < scene.tools.size(); ++t) fmt::print(",{:.6g}", nodes.force(static_cast<int>(t)).norm());
    fmt::print("\n");
  }
}

int run(int trials, const std::string& only) {
  int bad = 0;
  for (const std::string name : {"plate_cut", "hepatectomy", "cylinder_tear", "cylinder_hybrid", "block_partial"}) {
    if (!only.starts_with(only.empty() ? "" : name)) continue;
    const Scene scene = load_scene(scene_file(name));
    const std::vector<Archive> archives = load_or_precompute(scene, ArchivePart::surface);
    for (const Victim victim : {Victim::deform, Victim::haptic}) {
      const std::string row = name + (victim == Victim::deform ? "_deform" : "_haptic");
      if (only.empty() || only == name || only == row)
        bad += tell(row, storm(scene, archives, victim, trials), static_cast<int>(scene.tools.size()));
    }
  }
  return bad;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc == 6 && std::strcmp(argv[1], "course") == 0) {
      print_course(argv[2], std::strcmp(argv[3], "haptic") == 0 ? Victim::haptic : Victim::deform, std::atoi(argv[4]),
                   std::atoi(argv[5]));
      return 0;
    }
    int trials = palpate::bench::quick(argc, argv) ? 4 : 100;
    std::string only;
    for (int i = 1; i < argc; ++i) {
      if (std::strcmp(argv[i], "--quick") == 0) continue;
      if (const int number = std::atoi(argv[i]); number > 0)
        trials = number;
      else
        only = argv[i];
    }
    if (const int bad = run(trials, only); bad > 0) {
      fmt::print(stderr, "bench_storms: {} times a hand was given more than it may be\n", bad);
      return 1;
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_storms: {}\n", error.what());
    return 1;
  }
}

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/bus/log_reader.hpp"
#include "common/realtime/clock.hpp"
#include "idl/topics.hpp"
#include "tests/realtime/host_watch.hpp"
#include "tests/sanitized.hpp"
#include "tests/tools/session.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using namespace testing;

/// Whether a log holds a status of a node of this role with these words in it.
bool status_says(const fs::path& log, const std::string& role, const std::string& words) {
  LogReader reader(log);
  NodeStatus status;
  for (LogEvent event; reader.next(event);)
    if (event.read(topics::node_status, status) && status.role == role && status.text.find(words) != std::string::npos)
      return true;
  return false;
}

TEST(OverloadTest, TissueThatNoMachineKeepsUpWithIsSaidToFallBehind) {
  // 35,000 tetrahedra, of which a tick has 100 us.
  const LoopbackScene scene("overload", "[body.touchable]\nbox = [[-0.01, -0.01, -0.001], [0.01, 0.01, 0.001]]\n");
  write_tet_mesh(make_block({-0.05, -0.05, -0.05}, {0.05, 0.05, 0}, {22, 22, 12}), scene.folder() / "block.msh");
  scene.replace("quasi_static", "tensor_mass");
  scene.replace("[[tool]]", "[rates]\nhaptic_hz = 10000\n\n[[tool]]");
  scene.write("motion.csv", kLongRest);
  const fs::path log = scene.folder() / "session.lcmlog";
  const auto run = run_program(fmt::format("{} run {} --processes 3 --seconds 4 --domain {} --record {}",
                                           program("palpate"), scene.scene(), testing::own_domain(), log.string()));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.err.find("the tissue falls behind by"), std::string::npos) << run.err;
  EXPECT_TRUE(status_says(log, "deform", "the tissue falls behind by"));
}

constexpr double kHapticHz = 1000;
constexpr std::uint64_t kPressed = 4500;  // steps: pressed for long, and no node has ended yet

/// The force on the only tool in a log [N]: the largest, that of step kPressed or of the last before it, and the
/// largest change in a step.
struct Felt {
  double largest = 0, held = 0, change = 0;
};

Felt felt_in(const fs::path& log) {
  LogReader reader(log);
  Felt felt;
  ForceState before, force;
  for (LogEvent event; reader.next(event);) {
    if (!event.read(topics::force_state, force)) continue;
    const Eigen::Map<const Eigen::Vector3d> now(force.force.data()), last(before.force.data());
    felt.largest = std::max(felt.largest, now.norm());
    if (force.step == before.step + 1) felt.change = std::max(felt.change, (now - last).norm());
    if (force.step <= kPressed) felt.held = now.norm();
    before = force;
  }
  return felt;
}

/// Of what a node had to do, the share that it left out; of what the host kept from it, nothing.
double left_out(const json& summary, const char* node, const char* done, double host = 0) {
  const double missed = std::max(summary[node]["missed"].get<double>() - host, 0.);
  return missed / (missed + summary[node][done].get<double>());
}

/// Shares that were left out, and the force [N] beside that of a run in lock step.
struct Overloaded {
  double pictures = 0, tissue = 0, steps = 1;
  Felt felt, undisturbed;
  std::string said;
};

/// A block of moving tissue under a tool that comes down on it within 1.5 s and stands there. One with `cells` is run
/// on one core, beside so many busy loops, for as long as the loop's steps are left out, three times at most: a host
/// that stands still does so too, now and then. Nothing without the right to realtime priority.
std::optional<Overloaded> on_one_core(std::array<int, 3> cells, int busy_loops) {
  const LoopbackScene scene("one_core",
                            "[body.touchable]\nbox = [[-0.02, -0.02, -0.001], [0.02, 0.02, 0.001]]\n\n"
                            "[body.dynamic]\ndamping = 20\n");
  write_tet_mesh(make_block({-0.05, -0.05, -0.05}, {0.05, 0.05, 0}, cells), scene.folder() / "block.msh");
  scene.replace("quasi_static", "tensor_mass");
  scene.write("motion.csv", "time,yaw,pitch,depth,roll,grip\n0,0,0,0.185,0,0\n1.5,0,0,0.197,0,0\n60,0,0,0.197,0,0\n");
  const fs::path alone = scene.folder() / "alone.lcmlog";
  std::string said;
  EXPECT_EQ(
      run_command(fmt::format("{} drive {} --seconds 2 --log {}", program("palpate"), scene.scene(), alone.string()),
                  &said),
      0)
      << said;
  Overloaded found{.undisturbed = felt_in(alone)};
  std::vector<ChildProcess> busy;
  for (int i = 0; i < busy_loops; ++i)
    busy.emplace_back("busy",
                      std::vector<std::string>{"/usr/bin/taskset", "-c", "0", "/bin/sh", "-c", "while :; do :; done"});
  const Session session(scene.folder());
  for (int turn = 0; turn < 3 && found.steps > 0.02; ++turn) {
    const HostWatch host(HostWatch::By::host, {0});
    const std::int64_t begin = now_ns();
    const auto run = run_program("taskset -c 0 " + joined(session.arguments(scene, 3)) + "--force --seconds 5");
    EXPECT_EQ(run.status, 0) << run.err;
    if (run.status != 0 || run.err.find("realtime scheduling: FIFO") == std::string::npos) return {};
    const json summary = json::parse(text_of(session.summary));
    found.pictures = left_out(summary, "render_node", "frames");
    found.tissue = left_out(summary, "deform_node", "ticks");
    const double paused = host.stood_still(begin, now_ns());
    found.steps = left_out(summary, "haptic_node", "ticks", kHapticHz * paused);
    found.felt = felt_in(session.log);
    found.said = run.err;
    fmt::print(
        "left out: {:.1f} % of the pictures, {:.1f} % of the tissue's ticks, {:.2f} % of the loop's steps (beside "
        "{:.3f} s of the host); "
        "{:.4f} N at most, {:.4f} N held, by {:.4f} N a step; undisturbed {:.4f} N, {:.4f} N, {:.4f} N\n",
        100 * found.pictures, 100 * found.tissue, 100 * found.steps, paused, found.felt.largest, found.felt.held,
        found.felt.change, found.undisturbed.largest, found.undisturbed.held, found.undisturbed.change);
  }
  return found;
}

void expect_felt_as(const Felt& felt, const Felt& undisturbed) {
  EXPECT_GT(undisturbed.held, 0.1);
  EXPECT_LT(felt.largest, 1.1 * undisturbed.largest);
  EXPECT_LT(felt.change, 0.1 * undisturbed.held);
  EXPECT_NEAR(felt.held, undisturbed.held, 0.1 * undisturbed.held);
}

TEST(OverloadTest, BesideBusyLoopsPicturesAreLeftOutFirstAndAPressIsFelt) {
  if (kSanitized) GTEST_SKIP() << "nothing is in time there";
  const auto found = on_one_core({8, 8, 4}, 6);  // beside two a quick machine draws nearly all
  if (!found) GTEST_SKIP() << "no right to realtime priority";
  EXPECT_LT(found->steps, 0.02);
  EXPECT_GT(found->pictures, 0.2);
  EXPECT_LT(found->tissue, 0.5 * found->pictures);
  expect_felt_as(found->felt, found->undisturbed);
}

// The kernel stops all realtime threads of a core for 50 ms of each second in which they leave it nothing.
TEST(OverloadTest, OnOneCoreTheTissueFallsBehindTheForceDoesNotAndAPressIsFelt) {
  if (kSanitized) GTEST_SKIP() << "nothing is in time there";
  const auto found = on_one_core({30, 30, 16}, 0);
  if (!found) GTEST_SKIP() << "no right to realtime priority";
  EXPECT_LT(found->steps, 0.02);
  EXPECT_GT(found->tissue, 0.1);
  EXPECT_NE(found->said.find("the tissue falls behind by"), std::string::npos) << found->said;
  if (found->tissue < 0.8) return expect_felt_as(found->felt, found->undisturbed);
  // Models come too late to be felt in full; no more is felt all the same.
  EXPECT_LT(found->felt.largest, 1.1 * found->undisturbed.largest);
  EXPECT_LT(found->felt.change, 0.1 * found->undisturbed.held);
}

}  // namespace
}  // namespace palpate

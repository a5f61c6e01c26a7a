#include "tests/hostile/hostile.hpp"

#include "common/realtime/clock.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

constexpr double kMaxForce = 10, kMaxRise = 0.25;  // [N], [N] a step: the scene's defaults
constexpr double kMaxShare = 0.1;                  // of the undisturbed force, by which it may be off
constexpr double kMaxInFreeAir = 1;                // [N] more than this tissue's weight and 0.2 mm of its stiffness
constexpr double kFlatMb = 48;                     // by which a node may grow in all once its histories are full
constexpr double kMinHz = 980;                     // in an attack, of which some take a second
constexpr std::uint64_t kJudged = 200;  // steps at least; on a busy machine they come here later than pictures

}  // namespace

std::unique_ptr<HostWatch> Hostile::host_;
std::unique_ptr<AttackedSystem> Hostile::system_;
Hostile::Memory Hostile::memory_;

LocalContactModel press(std::uint64_t tool_run, std::uint64_t deform_run, std::uint64_t step, std::uint64_t seq) {
  LocalContactModel m{.tool = kHovering, .run = deform_run, .seq = seq, .tool_run = tool_run, .tool_step = step};
  m.depth = 0.186;
  m.contacts.push_back({0, 0, {0, 0, 0.006}, {0, 0, -1}, {0, 0, -10}, {}});
  return m;
}

void Hostile::SetUpTestSuite() {
  const std::string suite = ::testing::UnitTest::GetInstance()->current_test_suite()->name();
  host_ = std::make_unique<HostWatch>();
  system_ = std::make_unique<AttackedSystem>(own_domain(), suite.starts_with("WithKeys/"));
  memory_ = system_->memory_at_most();
}

void Hostile::TearDownTestSuite() {
  system_.reset();
  host_.reset();
}

void Hostile::SetUp() {
  if (!is_in_free_air() && system().press()) {
    memory_ = system_->memory_at_most();
    ASSERT_TRUE(system().is_undisturbed(20s));
  }
  system().begin_anew();
}

bool Hostile::is_in_free_air() {
  const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  return name.find("InFreeAir") != std::string::npos;
}

void Hostile::TearDown() {
  if (ended_) return;
  system_->watch(kAfterFlood, [] {
    const auto& first = hand().of(kHovering).first();
    return first && hand().newest().step > first->step + kJudged;
  });
  EXPECT_TRUE(system_->all_run());
  EXPECT_TRUE(!is_in_free_air() || system_->in_free_air()) << "it lasted to step " << hand().newest().step;
  for (int tool = 0; tool < hand().tools(); ++tool) expect_guarded(tool);
  const double rate_hz = hand().rate_hz(*host_);
  EXPECT_GE(rate_hz, kMinHz);
  const Growth in_all = grown_since(memory_);
  EXPECT_TRUE(in_all.mb < kFlatMb || kSanitized) << in_all.mb << " MB, of " << in_all.node;
  fmt::print("{:.0f} Hz; memory: {:.1f} MB more, of {}\n", rate_hz, in_all.mb, in_all.node);
  if (misled_) system_->press_again();
  EXPECT_TRUE(is_in_free_air() || system_->is_undisturbed(20s)) << "what was done lasts";
}

// A hand that rests is given what it was, or, while tissue or driver is silent, less.
void Hostile::expect_guarded(int tool) const {
  const FeltForce& felt = hand().of(tool);
  const double undisturbed = felt.undisturbed().norm();
  fmt::print("tool {}: {:.3f} N, {:.3f} N at most, {:.3f} N off, by {:.3f} N a step\n", tool, undisturbed,
             felt.max_force(), felt.max_off(), felt.max_change());
  EXPECT_TRUE(felt.finite()) << tool;
  EXPECT_LE(felt.max_force(), kMaxForce * (1 + 1e-9)) << tool;
  EXPECT_LE(felt.max_rise(), kMaxRise + 1e-9) << tool;
  // All tools have one account of energy: where one is thrown about and overdraws it, the others' forces fall too.
  if (misled_ && tool != kHovering) return;
  EXPECT_LE(felt.max_change(), kMaxRise + 1e-9) << tool;
  if (lied_to_) return;
  if (tool == kHovering || is_in_free_air()) {
    EXPECT_LT(felt.max_force(), kMaxInFreeAir);
  } else {
    EXPECT_GT(undisturbed, 4 * kMaxRise) << tool << " does not press";
    EXPECT_LE(felt.max_off(), kMaxShare * undisturbed + kMaxRise) << tool;
  }
}

Hostile::Growth Hostile::grown_since(const Memory& before) {
  Memory grown = system_->memory_mb();
  for (auto& [name, mb] : grown) mb -= before.at(name);
  const auto& [name, most] = *std::ranges::max_element(grown, {}, &Memory::value_type::second);
  return {most, name};
}

double Hostile::rate_hz(const nlohmann::json& said) {
  const double seconds = said.value("seconds", 0.0);
  const std::int64_t end = now_ns();
  return host_->rate_hz(said.value("rate_hz", 0.0) * seconds, end - static_cast<std::int64_t>(1e9 * seconds), end);
}

}  // namespace palpate::testing

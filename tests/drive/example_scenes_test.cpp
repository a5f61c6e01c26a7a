// Every example scene comes to what its title says, and its log is verified. In short where the point is reached early;
// to the end of its motion, with what it comes to only there, with PALPATE_LONG_TESTS. A change of a force from one
// step to the next [N] is bounded by half as much again as it is.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/sanitized.hpp"
#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

using testing::program;
using testing::run_program;

struct Example {
  const char* scene;
  double seconds;  ///< in short; 0: to its end
  std::vector<std::string> expected;
  std::vector<std::string> at_its_end = {};

  friend void PrintTo(const Example& example, std::ostream* out) { *out << example.scene; }
};

const std::vector<Example> kExamples{
    {"liver",
     0,
     {"tool.probe.force.max>0.3", "tool.probe.force.change<0.0013", "body.liver.displacement.max>0.012",
      "body.liver.displacement.end<1e-9"}},
    {"liver_visual", 3, {"tool.probe.force.max>0.2"}},
    {"liver_nonlinear", 0, {"tool.probe.force.max>0.2", "body.liver.displacement.end<1e-9"}},
    {"liver_two_tools",
     0,
     {"tool.probe.touching>4", "tool.second_probe.touching>4", "tool.probe.force.change<0.0016",
      "tool.second_probe.force.change<0.0013"}},
    {"two_hosts", 4, {"tool.probe.force.max>0.3", "tool.probe.force.change<0.0013"}},
    {"plate",
     0,
     {"tool.first.touching>4", "tool.second.touching>2", "tool.first.force.change<0.0006",
      "tool.second.force.change<0.0006"}},
    {"brain_cylinder",
     0,
     {"tool.ball.force.max>0.03", "tool.ball.force.change<0.00015", "body.specimen.displacement.max>0.003"}},
    {"plate_cut",
     3.5,
     {"body.plate.cut>0", "body.plate.torn==0", "tool.scalpel.force.change<0.06"},
     {"body.plate.pieces==2", "body.plate.off>900"}},
    {"cylinder_tear",
     0,
     {"body.cylinder.torn>50", "body.cylinder.cut==0", "body.cylinder.pieces==1", "body.cylinder.fallen>200"}},
    {"cylinder_tear_alone",
     0,
     {"body.cylinder.torn>50", "body.cylinder.cut==0", "body.cylinder.pieces==1", "body.cylinder.fallen>400",
      "body.cylinder.displacement.max>0.1"}},
    {"cylinder_hybrid",
     6,
     {"body.cylinder.pieces==1", "tool.probe.touching>1.5", "body.cylinder.displacement.max>0.01",
      "tool.probe.force.change<0.001"}},
    {"block_partial",
     5,
     {"tool.probe.force.max>0.04", "tool.probe.touching>1", "body.block.displacement.max>0.0015",
      "body.block.pieces==1", "body.block.off==0"},
     {"body.block.displacement.end<0.0009"}},
    {"hepatectomy",
     10.5,
     {"body.liver.cut>200", "body.liver.cut.inside>200", "body.liver.cut.outside<30", "body.liver.torn==0",
      "body.liver.fallen==0", "body.liver.pieces==2", "body.liver.off>200", "tool.scalpel.force.change<0.03"},
     // the 216 tetrahedra that the forceps carry weigh 0.0621 N
     {"tool.forceps.force.end>0.056", "tool.forceps.force.end<0.068"}},
    {"duct_poke",
     0,
     {"tool.forceps.force.max>0.2", "tool.forceps.grip.max>0.01", "body.duct.displacement.max>0.003",
      "tool.forceps.force.change<0.02"}},
    {"catheter_insertion",
     17.5,
     {"body.catheter.inserted>0.02", "body.catheter.grasps>0", "body.catheter.drops==0"},
     {"body.catheter.deepest>0.03"}}};

class ExampleRun : public ::testing::TestWithParam<Example> {};

// Sanitizers slow the tissue down too much for more than its beginning.
constexpr double kLongest = testing::kSanitized ? 1 : 0;

std::string command_for(const Example& example, const std::string& log) {
  std::vector<std::string> expected{"finite==1", "tool.limited==0", "tool.fault==0"};
  const auto expect = [&](const auto& more) { expected.insert(expected.end(), more.begin(), more.end()); };
  const bool to_its_end = std::getenv("PALPATE_LONG_TESTS") || example.seconds == 0;
  if (kLongest == 0) expect(example.expected);
  if (kLongest == 0 && to_its_end) expect(example.at_its_end);
  std::string command = fmt::format("{} drive {}/scenes/{}.toml", program("palpate"), PALPATE_SOURCE, example.scene);
  for (const std::string& e : expected) command += fmt::format(" --expect \"{}\"", e);
  const double seconds = kLongest > 0 ? kLongest : to_its_end ? 0 : example.seconds;
  if (seconds > 0) command += fmt::format(" --seconds {}", seconds);
  return command + " --log " + log;
}

TEST_P(ExampleRun, ComesToWhatItsTitleSays) {
  const Example& example = GetParam();
  const testing::OwnFolder folder("example");
  const std::string log = folder / "run.lcmlog";
  const auto run = run_program(command_for(example, log));
  EXPECT_EQ(run.status, 0) << run.err << run.out;
  const auto verified = run_program(program("palpate") + " replay --verify " + log);
  EXPECT_EQ(verified.status, 0) << verified.err;
}

INSTANTIATE_TEST_SUITE_P(Scenes, ExampleRun, ::testing::ValuesIn(kExamples),
                         [](const auto& info) { return std::string(info.param.scene); });

// A scene that is added says here what it comes to.
TEST(ExampleRuns, CoverEveryScene) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PALPATE_SOURCE "/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    ++scenes;
    const std::string name = entry.path().stem();
    EXPECT_TRUE(std::ranges::any_of(kExamples, [&](const Example& e) { return name == e.scene; })) << name;
  }
  EXPECT_EQ(scenes, static_cast<int>(kExamples.size()));
}

}  // namespace
}  // namespace palpate

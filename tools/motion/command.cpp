#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/scene/ensure_archive.hpp"
#include "common/scene/moved_files.hpp"
#include "tools/motion/choose_tool.hpp"
#include "tools/motion/motion_maker.hpp"
#include "tools/shared/child_process.hpp"
#include "tools/shared/choose_body.hpp"
#include "tools/shared/commands.hpp"

namespace palpate {
namespace {

struct MotionOptions {
  std::string scene, out, tool, body, picture;
  std::vector<std::string> steps;
  MotionManner manner;
  bool json = false;
};

/// What the tool felt in a part of its motion.
struct PartFelt {
  const MotionMaker::Part& part;
  double largest = 0, end = 0;  ///< [N]
};

std::vector<PartFelt> felt_in_parts(const MotionMaker& maker, const Rehearsal& rehearsal) {
  const std::vector<double> felt = rehearsal.forces(maker.rows().trajectory());
  const auto at = [&](double time) {
    return std::min(static_cast<std::size_t>(time / rehearsal.dt()), felt.size() - 1);
  };
  std::vector<PartFelt> all;
  for (const MotionMaker::Part& part : maker.parts()) {
    const auto first = felt.begin() + static_cast<std::ptrdiff_t>(at(part.begin));
    const auto last = felt.begin() + static_cast<std::ptrdiff_t>(at(part.end));
    all.push_back({part, *std::max_element(first, last + 1), *last});
  }
  return all;
}

void print_parts(const std::vector<PartFelt>& parts) {
  fmt::print("   from [s]    to [s]   largest force [N]   at the end [N]   step\n");
  for (const PartFelt& p : parts)
    fmt::print("{:11.2f}{:10.2f}{:20.3f}{:17.3f}   {}\n", p.part.begin, p.part.end, p.largest, p.end, p.part.step.text);
}

/// A force that could not be met is told of: tissue that does not come to rest, is cut, or is pressed by another tool.
void tell_of_missed_forces(const std::vector<PartFelt>& parts) {
  constexpr double kMissed = 0.05;
  for (const PartFelt& p : parts) {
    if (p.part.step.kind != MotionStep::Kind::press_with) continue;
    const double share = p.end / p.part.step.value - 1;
    if (std::abs(share) <= kMissed) continue;
    fmt::print(stderr, "palpate: '{}': the force at its end is {:.3g} N, {:.0f} % too {}\n", p.part.step.text, p.end,
               100 * std::abs(share), share < 0 ? "small" : "large");
  }
}

void print_json(const std::vector<PartFelt>& parts, const std::string& file, double seconds) {
  nlohmann::ordered_json steps = nlohmann::ordered_json::array();
  for (const PartFelt& p : parts)
    steps.push_back({{"step", p.part.step.text},
                     {"from_s", p.part.begin},
                     {"to_s", p.part.end},
                     {"max_force_n", p.largest},
                     {"end_force_n", p.end}});
  fmt::print("{}\n", nlohmann::ordered_json{{"file", file}, {"seconds", seconds}, {"steps", steps}}.dump());
}

/// Pictures are drawn by a program of its own.
void draw(const MotionOptions& o, const std::string& tool) {
  ChildProcess path("palpate path",
                    {sibling_program("palpate_film"), "path", o.scene, o.out, "--tool", tool, "-o", o.picture});
  while (!path.wait(std::chrono::milliseconds(100)))
    ;
  if (path.status() != 0) throw std::runtime_error(fmt::format("{}: it could not be drawn", o.picture));
}

void make_motion(const MotionOptions& o) {
  std::vector<MotionStep> steps;
  for (const std::string& text : o.steps) steps.push_back(parse_motion_step(text));
  const Scene scene = load_scene(o.scene);
  keep_files_of(scene, {o.out});
  const int tool = choose_tool(scene, o.tool);
  const std::string body = name_of(choose_body(scene, o.body));
  const std::vector<Archive> archives = load_or_precompute(scene, ArchivePart::surface);
  const auto touched = std::ranges::find(scene.bodies, body, [](const Body& b) { return name_of(b); });
  const Rehearsal rehearsal(scene, archives, tool);
  MotionMaker maker(scene.tools[tool], archives[touched - scene.bodies.begin()].surface, rehearsal, o.manner);
  maker.add(steps);

  std::string comment = fmt::format("{} on {}:", scene.tools[tool].name, body);
  for (const MotionStep& step : steps) comment += fmt::format(" {};", step.text);
  maker.rows().write(o.out, comment);
  const std::vector<PartFelt> parts = felt_in_parts(maker, rehearsal);
  if (std::ranges::none_of(parts, [](const PartFelt& p) { return p.largest > 0; }))
    fmt::print(stderr, "palpate: {}: the tool touches nothing on all of its way\n", o.out);
  tell_of_missed_forces(parts);
  if (!o.picture.empty()) draw(o, scene.tools[tool].name);
  if (o.json) return print_json(parts, o.out, maker.rows().time());
  print_parts(parts);
  fmt::print(
      "{}: {:.2f} s; as `trajectory` of a scripted tool, or at once: palpate drive {} --set tool.{}.trajectory={}\n",
      o.out, maker.rows().time(), o.scene, scene.tools[tool].name, std::filesystem::absolute(o.out).string());
  if (!o.picture.empty())
    fmt::print("{}: the way of the tip over the organ at rest, with a ball where it stands\n", o.picture);
}

}  // namespace

void add_motion_command(cli::Command& app) {
  cli::Command command =
      app.add_command("motion",
                      "Make a tool's motion of steps, and say what the tool feels in each: to X,Y,Z (above the "
                      "surface's nearest place), "
                      "press DEPTH or FORCE, hold TIME, slide X,Y,Z, withdraw, grip ANGLE, pedal 0|1");
  auto o = std::make_shared<MotionOptions>();
  command.add_option("SCENE", o->scene, "Scene file (TOML)").required();
  command.add_option("STEP", o->steps, "Steps, in their order; each is one word of the shell").required();
  command.add_option("-o,--output", o->out, "Trajectory (CSV)").required().output_file(".csv", {"motion"});
  command.add_option("--picture", o->picture, "Picture of the way over the organ (PNG)").output_file(".png");
  command.add_option("--tool", o->tool, "Tool that moves (default: the only one)");
  command.add_option("--body", o->body, "Body that it touches (default: the only one)");
  command.add_option("--speed", o->manner.speed, "Of the tip [m/s], at most").between(1e-4, 1.0).show_default();
  command.add_option("--clear", o->manner.clear, "Between tip and tissue where it does not press [m]")
      .between(1e-4, 1.0)
      .show_default();
  command.add_flag("--json", o->json, "Print what the tool feels as one line of JSON");
  command.examples(
      {"palpate motion scenes/liver.toml \"to 0,0,60mm\" \"press 5mm\" \"slide 20mm,0,60mm\" \"press 0.3N\" \"hold "
       "1s\" withdraw -o press.csv --picture press.png"});
  command.does([o] { make_motion(*o); });
}

}  // namespace palpate

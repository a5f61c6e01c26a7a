#include "common/shell/modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "common/models/vibration.hpp"
#include "common/scene/scene_changes.hpp"
#include "tools/shared/choose_body.hpp"
#include "tools/shared/commands.hpp"
#include "tools/shared/set_option.hpp"

namespace palpate {
namespace {

struct ModesArguments {
  std::string scene, body;
  std::vector<std::string> set;
  int count = 10;
  bool json = false;
};

std::vector<double> in_hertz(const Eigen::VectorXd& omega) {
  std::vector<double> frequencies;
  for (const double w : omega) frequencies.push_back(w / (2 * std::numbers::pi));
  return frequencies;
}

void print_modes(const ModesArguments& arguments) {
  const Scene scene = load_scene(arguments.scene, parse_changes(arguments.set));
  const Body& body = choose_body(scene, arguments.body);
  const FreeVibration free = std::visit([](const auto& spec) { return vibration(spec); }, body);
  const int count = std::min(arguments.count, static_cast<int>(free.mass.size()));
  const Modes modes = lowest_modes(free.stiffness, free.mass, count, free.shift);
  const std::vector<double> frequencies = in_hertz(modes.omega);
  if (arguments.json) {
    fmt::print("{}\n", nlohmann::json{{"body", name_of(body)}, {"frequency_hz", frequencies}}.dump());
    return;
  }
  fmt::print("mode,frequency_hz\n");
  for (int m = 0; m < count; ++m) fmt::print("{},{:.6g}\n", m + 1, frequencies[m]);
}

}  // namespace

void add_modes_command(cli::Command& app) {
  cli::Command command = app.add_command(
      "modes", "Frequencies at which a body swings freely, of its own elements: CSV on the standard output");
  auto arguments = std::make_shared<ModesArguments>();
  command.add_option("SCENE", arguments->scene, "Scene file").required();
  add_set_option(command, arguments->set);
  command.add_option("--body", arguments->body, "Name of the body; needed where the scene has several");
  command.add_option("--count", arguments->count, "How many, from the lowest").between(1, 1000).show_default();
  command.add_flag("--json", arguments->json, "Print one line of JSON");
  command.examples({"palpate modes scenes/plate_cut.toml --count 12",
                    "palpate modes scenes/plate_cut.toml --set body.young=20000 --json"});
  command.does([arguments] { print_modes(*arguments); });
}

}  // namespace palpate

#include "common/shell/modes.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "common/fem/factorisation.hpp"
#include "common/models/vibration.hpp"
#include "common/scene/scene_changes.hpp"
#include "tools/shared/choose_body.hpp"
#include "tools/shared/commands.hpp"
#include "tools/shared/set_option.hpp"

namespace palpate {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct ModesArguments {
  std::string scene, body;
  std::vector<std::string> set;
  int count = 10;
  bool json = false;
};

constexpr int kGuard = 6;          // modes beyond the wanted ones: the last wanted ones converge faster
constexpr int kPasses = 50;        // at most
constexpr double kSettled = 1e-8;  // relative change of a frequency in a pass

/// [rad/s] with the mass that is not lumped: subspace iteration from the modes of the lumped one (Bathe, sec. 11.6).
VectorXd frequencies_with_own_mass(const FreeVibration& free, const Modes& lumped, int count) {
  Factorisation factor(free.stiffness);
  factor.factorise(free.stiffness);
  MatrixXd shape = lumped.shape, inertia = free.consistent_mass(shape);
  VectorXd omega = lumped.omega;
  for (int pass = 0; pass < kPasses; ++pass) {
    shape = factor.solve(inertia);
    const MatrixXd stiffness = shape.transpose() * inertia;
    inertia = free.consistent_mass(shape);
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> ritz(stiffness, shape.transpose() * inertia);
    shape *= ritz.eigenvectors();
    inertia *= ritz.eigenvectors();
    const VectorXd before = std::exchange(omega, ritz.eigenvalues().cwiseSqrt());
    if (((omega - before).array().abs() <= kSettled * omega.array()).head(count).all()) break;
  }
  return omega.head(count);
}

VectorXd frequencies_of(const FreeVibration& free, int count) {
  const auto all = static_cast<int>(free.mass.size());
  if (!free.consistent_mass) return lowest_modes(free.stiffness, free.mass, std::min(count, all), free.shift).omega;
  const Modes lumped = lowest_modes(free.stiffness, free.mass, std::min(count + kGuard, all), free.shift);
  return frequencies_with_own_mass(free, lumped, std::min(count, all));
}

std::vector<double> in_hertz(const VectorXd& omega) {
  std::vector<double> frequencies;
  for (const double w : omega) frequencies.push_back(w / (2 * std::numbers::pi));
  return frequencies;
}

void print_modes(const ModesArguments& arguments) {
  const Scene scene = load_scene(arguments.scene, parse_changes(arguments.set));
  const Body& body = choose_body(scene, arguments.body);
  const FreeVibration free = std::visit([](const auto& spec) { return vibration(spec); }, body);
  const std::vector<double> frequencies = in_hertz(frequencies_of(free, arguments.count));
  if (arguments.json) {
    fmt::print("{}\n", nlohmann::json{{"body", name_of(body)}, {"frequency_hz", frequencies}}.dump());
    return;
  }
  fmt::print("mode,frequency_hz\n");
  for (std::size_t m = 0; m < frequencies.size(); ++m) fmt::print("{},{:.6g}\n", m + 1, frequencies[m]);
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

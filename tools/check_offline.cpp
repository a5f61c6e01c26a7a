#include "tools/check_offline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "common/fem/fine_space.hpp"

namespace palpate {
namespace {

/// Where the compliance of a disc whose radius is four elements comes out a tenth too small (docs/offline.md).
constexpr double kLocking = 0.48;

double max_poisson(const SolidSpec& body) {
  double largest = body.material.poisson;
  for (const auto& region : body.materials) largest = std::max(largest, region.material.poisson);
  return largest;
}

bool has_linear_displacement(const std::optional<Offline>& offline) {
  return !offline || (offline->element == "p1" && offline->formulation == "displacement");
}

}  // namespace

void print_offline(const QuasiStaticSpec& body, const TetMesh& mesh) try {
  if (!is_finer(body.offline)) return;
  const auto space = make_fine_space(mesh, *body.offline);
  fmt::print("  offline: tensors from {} {} tetrahedra with {} nodes, {}\n", space.elements.size(),
             space.per_element == 4 ? "linear" : "quadratic", space.nodes.size(),
             body.offline->formulation == "locking_free" ? "locking-free" : "displacement formulation");
} catch (const std::runtime_error& error) {
  throw std::runtime_error(fmt::format("body '{}': [body.offline]: {}", body.name, error.what()));
}

std::vector<std::string> locking_warnings(const Body& body) {
  const auto* solid = as<SolidSpec>(body);
  if (!solid) return {};
  const double poisson = max_poisson(*solid);
  if (poisson < kLocking) return {};
  const auto start = fmt::format(
      "body '{}': linear elements lock at poisson = {} and are too stiff, by a tenth at {} and "
      "several times at 0.4999: ",
      solid->name, poisson, kLocking);
  if (const auto* still = as<QuasiStaticSpec>(body)) {
    if (!has_linear_displacement(still->offline)) return {};
    return {start + "give it a [body.offline] with element = \"p2\" and formulation = \"locking_free\""};
  }
  if (as<SpringMassSpec>(body)) return {};
  return {start +
          fmt::format("take {} for tissue that moves, which true incompressibility stiffens by 4 % only", kLocking)};
}

}  // namespace palpate

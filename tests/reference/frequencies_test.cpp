#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "bench/shell_bodies.hpp"
#include "common/shell/modes.hpp"
#include "tests/reference/loads.hpp"

/// Frequencies of shells on coarser meshes than those of bench_modal_frequencies, for the orders on
/// docs/verification.md.
namespace palpate {
namespace {

using bench::kSteel;

/// The lowest frequencies [Hz] after `rigid` motions, entered as a property of the running test.
std::vector<double> frequencies(const std::string& name, const ShellSystem& system, int rigid, int count,
                                double shift = 0) {
  const auto modes = lowest_modes(system.stiffness, system.mass, rigid + count, shift);
  std::vector<double> hertz;
  std::string text;
  for (int m = rigid; m < rigid + count; ++m) {
    hertz.push_back(modes.omega[m] / (2 * std::numbers::pi));
    text += fmt::format("{:.9g} ", hertz.back());
  }
  ::testing::Test::RecordProperty(name, text);
  return hertz;
}

TEST(Frequencies, OfASupportedPlateConvergeAtSecondOrder) {
  const double rigidity = kSteel.young * std::pow(kSteel.thickness, 3) / 12 / (1 - kSteel.poisson * kSteel.poisson);
  const double exact =
      std::numbers::pi / bench::kSide / bench::kSide * std::sqrt(rigidity / (kSteel.density * kSteel.thickness));
  const auto error = [&](int cells) {
    return std::abs(
        frequencies(fmt::format("plate_supported_n{}", cells), bench::supported_plate(cells), 0, 8)[0] / exact - 1);
  };
  EXPECT_NEAR(testing::order(error(7), error(14)), 2, 0.2);
}

TEST(Frequencies, OfTheOtherKnownShellsComeNearerOnTheFinerMesh) {
  for (int cells : {7, 14}) {
    const auto free = frequencies(fmt::format("plate_free_n{}", cells), bench::free_plate(cells), 6, 7, 100);
    const auto membrane = frequencies(fmt::format("tapered_membrane_n{}", cells), bench::tapered_membrane(cells), 0, 6);
    const auto strip = frequencies(fmt::format("cantilever_strip_n{}", cells), bench::cantilever_strip(cells), 0, 3);
    const double close = cells == 7 ? 0.15 : 0.04;
    EXPECT_NEAR(free[0], 1.622, close * 1.622);
    EXPECT_NEAR(membrane[0], 44.623, close * 44.623);
    EXPECT_NEAR(strip[0], 0.40384, close * 0.40384);
  }
  for (int cells : {16, 32}) {
    const auto round =
        frequencies(fmt::format("cylinder_n{}", cells), bench::cylinder(cells, cells * 5 / 8), 1, 10, 1e4);
    EXPECT_NEAR(round[0], 46.261, (cells == 16 ? 0.15 : 0.04) * 46.261);
  }
}

}  // namespace
}  // namespace palpate

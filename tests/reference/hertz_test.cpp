#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "common/mesh/generators.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "common/sim/haptic_step.hpp"

/// A frictionless tip of radius R pressed into the middle of a block, nu = 0.3, by the haptic step, which holds
/// nodes, against Hertz. The tip's axis stands at several places between the nodes: how many nodes carry the contact
/// depends on it. The figures are on docs/verification.md.
namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kTipRadius = 0.01, kBlockYoung = 5000, kBlockPoisson = 0.3;
constexpr std::array<std::array<double, 2>, 4> kPlaces{{{0, 0}, {0.25, 0.1}, {0.5, 0.25}, {0.5, 0.5}}};  ///< over h

/// Grid coordinates from 0 outwards: steps of h to `fine`, then growing by 1.5 to exactly `end`.
std::vector<double> graded(double h, double fine, double end) {
  std::vector<double> x{0};
  while (x.back() < fine - 1e-12) x.push_back(x.back() + h);
  const std::size_t first = x.size();
  for (double step = h; x.back() < end;) x.push_back(x.back() + (step *= 1.5));
  const double from = x[first - 1], stretch = (end - from) / (x.back() - from);
  for (std::size_t i = first; i < x.size(); ++i) x[i] = from + stretch * (x[i] - from);
  return x;
}

TetMesh block(double h, double extent) {
  const auto half = graded(h, 1.25 * kTipRadius, extent);
  std::vector<double> across, down;
  for (auto x = half.rbegin(); x != half.rend(); ++x) down.push_back(-*x);
  across = down;
  across.insert(across.end(), half.begin() + 1, half.end());
  return make_graded_block(across, across, down);
}

/// A block on its base with elements of size h under the tip, ready to be pressed at any place. `extent`: its
/// height and half-width.
class Block {
 public:
  Block(double h, const std::optional<Offline>& offline, double extent = 8 * kTipRadius) : h_(h) {
    QuasiStaticSpec body;
    body.name = "block";
    body.material = {.young = kBlockYoung, .poisson = kBlockPoisson, .density = 1000};
    body.fixed.push_back({.where = {.group = "bottom"}});
    const double reach = 1.2 * kTipRadius;
    body.touchable = NodeSelector{{.box = Box{{-reach, -reach, -1e-6}, {reach, reach, 1e-6}}}};
    body.offline = offline;
    archives_.push_back(precompute(body, block(h, extent)));
    scene_.bodies.push_back(body);
    scene_.contact.friction = 0;
    scene_.contact.rule = ContactRule::barycentric;
  }

  /// Force [N] on the tip at a depth [m].
  double press(const std::array<double, 2>& place, double depth) {
    Tool tool;
    tool.name = "ball";
    tool.pivot = Vector3d(h_ * place[0], h_ * place[1], 0.2);
    std::get<ProbeSpec>(tool.end).radius = kTipRadius;
    tool.max_force = 1e3;
    tool.max_force_rate = 1e9;
    scene_.tools = {tool};
    const auto tip = [&](double z) {
      const Vector3d centre(tool.pivot.x(), tool.pivot.y(), z);
      return std::array{dofs_for_tip(make_trocar(tool.pivot, tool.axis, tool.up), centre, 0)};
    };
    HapticStep haptic(scene_, archives_);
    haptic.start(tip(1.05 * kTipRadius));
    constexpr int steps = 200;
    for (int i = 0; i <= steps + 20; ++i)
      haptic.step(tip(1.05 * kTipRadius - (depth + 0.05 * kTipRadius) * std::min(1.0, double(i) / steps)));
    return haptic.force(0).z();
  }

 private:
  double h_;
  Scene scene_;
  std::vector<Archive> archives_;
};

double hertz(double depth) {
  return 4.0 / 3 * kBlockYoung / (1 - kBlockPoisson * kBlockPoisson) * std::sqrt(kTipRadius) * std::pow(depth, 1.5);
}

/// F / Hertz at every place.
struct Pressed {
  std::array<double, kPlaces.size()> ratio{};

  double mean() const {
    double sum = 0;
    for (double r : ratio) sum += r / ratio.size();
    return sum;
  }
  double worst() const {
    double worst = 0;
    for (double r : ratio) worst = std::max(worst, std::abs(r - 1));
    return worst;
  }
};

/// Presses at every place and enters the ratios as a property of the running test.
Pressed press_everywhere(Block& block, double depth, const std::string& name) {
  Pressed pressed;
  std::string text;
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    pressed.ratio[i] = block.press(kPlaces[i], depth) / hertz(depth);
    text += fmt::format("{:.4f} ", pressed.ratio[i]);
  }
  ::testing::Test::RecordProperty(name, text);
  std::printf("%s: F / Hertz %s\n", name.c_str(), text.c_str());
  return pressed;
}

bool long_form() {
  return std::getenv("PALPATE_LONG_TESTS") != nullptr;
}

TEST(HertzReference, ATipFollowsHertzWithinTenPercentFromTwoElementsToItsRadius) {
  Pressed last;
  for (int per_radius : {2, 4, 8}) {
    if (per_radius == 8 && !long_form()) continue;
    Block block(kTipRadius / per_radius, std::nullopt);
    const auto pressed = press_everywhere(block, 0.5 * kTipRadius, fmt::format("p1_h{}", per_radius));
    EXPECT_LT(pressed.worst(), 0.1) << "R = " << per_radius << " h";
    if (per_radius > 2) {
      EXPECT_NEAR(pressed.mean(), last.mean(), 0.05) << "halving h to R / " << per_radius;
    }
    last = pressed;
    const auto shallow = press_everywhere(block, 0.25 * kTipRadius, fmt::format("p1_shallow_h{}", per_radius));
    EXPECT_LT(shallow.worst(), per_radius == 2 ? 0.25 : 0.12) << "R = " << per_radius << " h";
  }
}

TEST(HertzReference, ABlockOfTwiceTheSizeIsALittleSofter) {
  Block usual(kTipRadius / 2, std::nullopt), large(kTipRadius / 2, std::nullopt, 16 * kTipRadius);
  const double depth = 0.5 * kTipRadius, mean = press_everywhere(usual, depth, "usual_block").mean();
  const double far = press_everywhere(large, depth, "large_block").mean();
  EXPECT_LT(far, mean);
  EXPECT_GT(far, 0.95 * mean);
}

// A refinement offline leaves the nodes that carry the contact as few as they are: at R = 2h the mean is no
// better, and the places differ as much as on the mesh itself.
TEST(HertzReference, ARefinementOfflineDoesNotCureTheDependenceOnThePlace) {
  Block coarse(kTipRadius / 2, Offline{1, FiniteElement::p1, Formulation::displacement});
  const auto pressed = press_everywhere(coarse, 0.5 * kTipRadius, "refined_h2");
  EXPECT_GT(*std::max_element(pressed.ratio.begin(), pressed.ratio.end()) -
                *std::min_element(pressed.ratio.begin(), pressed.ratio.end()),
            0.08);
  EXPECT_LT(pressed.worst(), 0.15);
  if (!long_form()) return;
  Block fine(kTipRadius / 4, Offline{1, FiniteElement::p1, Formulation::displacement});
  EXPECT_LT(press_everywhere(fine, 0.5 * kTipRadius, "refined_h4").worst(), 0.05);
}

}  // namespace
}  // namespace palpate

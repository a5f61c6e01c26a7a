#include "tools/study/budget.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/study/small_scenes.hpp"
#include "tools/study/quasi_static.hpp"

/// What a budget buys.
namespace palpate::study {
namespace {

using namespace testing;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Points that are given, of one body.
class Given : public Method {
 public:
  Given(int body, std::vector<Point> points) : body_(body), points_(std::move(points)) {}
  int body() const override { return body_; }
  std::vector<Point> points() const override { return points_; }
  Result evaluate(const Point&) override { return {}; }

 private:
  int body_;
  std::vector<Point> points_;
};

Scene scene_of(int bodies) {
  Scene scene;
  for (int b = 0; b < bodies; ++b) {
    QuasiStaticSpec body;
    body.name = "body" + std::to_string(b);
    scene.bodies.push_back(body);
  }
  return scene;
}

Point point(
    const std::string& method, const std::string& value, std::function<void(Scene&)> apply = [](Scene&) {},
    bool serves = true) {
  return {method, "k", value, std::move(apply), serves};
}

Row row(const std::string& method, const std::string& value, double median, double p99, double err_u, double err_f,
        const std::string& reference = "fine_linear") {
  return {"s", method, "k", value, median, p99, 0, 0, err_u, err_f, reference};
}

std::vector<std::string> values_of(const std::optional<Choice>& choice) {
  std::vector<std::string> values;
  if (choice)
    for (const Point& p : choice->points) values.push_back(p.value);
  return values;
}

TEST(Budget, TakesTheMostAccurateThatFitsAndNothingWhereNothingDoes) {
  Methods methods;
  Result result;
  for (int b = 0; b < 2; ++b) {
    const std::string m = "m" + std::to_string(b);
    methods.push_back(
        std::make_unique<Given>(b, std::vector{point(m, "fast"), point(m, "slow"), Point{m, "k", "best", {}, true},
                                               point(
                                                   m, "other", [](Scene&) {}, false)}));
    result.rows.push_back(row(m, "fast", 10, 10, 0.3, 0.2));
    result.rows.push_back(row(m, "slow", 100, 100, 0.05, 0.1));
    result.rows.push_back(row(m, "best", 1, 1, 0, 0));   // no scene can say it
    result.rows.push_back(row(m, "other", 1, 1, 0, 0));  // does not serve
  }
  const auto values = [&](double budget) { return values_of(choose(methods, scene_of(2), result, budget)); };
  EXPECT_EQ(values(250e-6), (std::vector<std::string>{"slow", "slow"}));
  EXPECT_EQ(values(50e-6), (std::vector<std::string>{"fast", "fast"}));
  EXPECT_TRUE(values(15e-6).empty());
}

TEST(Budget, BuysNothingWhoseForceOrTimeCourseHasNoFigure) {
  Methods methods;
  methods.push_back(std::make_unique<Given>(0, std::vector{point("m", "v")}));
  const auto buys = [&](double still_force, double moving_force, double still_time, double moving_time) {
    Result result;
    result.rows.push_back(row("m", "v", still_time, still_time, 0.1, still_force, "finest_chain"));
    result.rows.push_back(row("m", "v", moving_time, moving_time, 0.1, moving_force, "finest_insertion"));
    return choose(methods, scene_of(1), result, 50e-6).has_value();
  };
  EXPECT_TRUE(buys(0.1, 0.1, 10, 10));
  EXPECT_FALSE(buys(kNan, 0.1, 10, 10));
  EXPECT_FALSE(buys(0.1, kNan, 10, 10));
  EXPECT_FALSE(buys(0.1, 0.1, 10, 60)) << "the slower of its steps counts";
  EXPECT_FALSE(buys(0.1, 0.1, 60, 10));
}

TEST(Budget, JudgesByMediansAndOnAQuietRunByThe99thPercentilesToo) {
  Methods methods;
  methods.push_back(std::make_unique<Given>(0, std::vector{point("m", "fast"), point("m", "slow")}));
  const auto values = [&](double p99_of_slow, double p99_of_others) {
    Result result;
    result.rows = {row("m", "fast", 10, 11, 0.3, 0.3), row("m", "slow", 40, p99_of_slow, 0.1, 0.1)};
    for (int i = 0; i < 3; ++i) result.rows.push_back(row("other", "x", 10, p99_of_others, 0.1, 0.1));
    return values_of(choose(methods, scene_of(1), result, 50e-6));
  };
  EXPECT_EQ(values(45, 12), std::vector<std::string>{"slow"});
  EXPECT_EQ(values(200, 12), std::vector<std::string>{"fast"}) << "a slow step on a quiet machine is the step's own";
  EXPECT_EQ(values(200, 60), std::vector<std::string>{"slow"}) << "on a busy machine it is another's";
}

TEST(Budget, KeepsEveryTableOfTheScene) {
  Scene scene = scene_of(1);
  std::get<QuasiStaticSpec>(scene.bodies[0]).relaxation = Relaxation{{0.5}, {0.2}};
  Methods methods;
  const auto without = [](Scene& s) { std::get<QuasiStaticSpec>(s.bodies[0]).relaxation.reset(); };
  methods.push_back(std::make_unique<Given>(0, std::vector{point("m", "as it is"), point("m", "without", without)}));
  Result result;
  result.rows = {row("m", "as it is", 10, 10, 0.5, 0.5), row("m", "without", 1, 1, 0, 0)};
  EXPECT_EQ(values_of(choose(methods, scene, result, 1e-3)), std::vector<std::string>{"as it is"});
}

/// What a budget may choose of a quasi-static body, each point but the scene's own being without error and cost.
std::vector<std::string> offered(const Scene& scene) {
  Methods methods;
  methods.push_back(make_quasi_static(std::make_shared<SolidCase>(scene, 0, on_one(scene), false)));
  std::vector<std::string> offered;
  for (const Point& best : methods[0]->points()) {
    Result result;
    for (const Point& p : methods[0]->points())
      result.rows.push_back(
          {"s", p.method, p.knob, p.value, 10, 10, 0, 0, p.value == best.value ? 0 : 0.5, 0, "fine_linear"});
    const auto choice = choose(methods, scene, result, 1e-3);
    if (choice && choice->points[0].value == best.value) offered.push_back(best.knob + " " + best.value);
  }
  return offered;
}

TEST(Budget, OffersOfAQuasiStaticBodyWhatItsSceneLeavesOpen) {
  const Folder folder;
  const auto has = [](const std::vector<std::string>& all, const std::string& text) {
    return std::ranges::count(all, text) > 0;
  };
  const auto open = offered(block_scene(folder.at));
  EXPECT_TRUE(has(open, "scene as it is") && has(open, "rule barycentric") && has(open, "offline p2 refine 1"));
  EXPECT_FALSE(has(open, "rule alpha")) << "which is there for comparison";

  const std::string curves = PALPATE_SOURCE_DIR "/scenes/curves/";
  const auto corrected = offered(block_scene(folder.at, "[body.nonlinear]\nforce_curve = \"" + curves +
                                                            "brain_force_5mm_min.csv\"\nradial_curve = \"" + curves +
                                                            "brain_radial.csv\"\nradius = 0.015\nheight = 0.013\n"));
  EXPECT_TRUE(has(corrected, "scene as it is"));
  EXPECT_FALSE(has(corrected, "correction off"));

  const auto better = offered(block_scene(folder.at, "[body.offline]\nelement = \"p2\"\n"));
  EXPECT_FALSE(has(better, "offline refine 1"));

  Scene scene = block_scene(folder.at);
  scene.contact.rule = ContactRule::barycentric;
  EXPECT_FALSE(has(offered(scene), "rule patch"));
}

}  // namespace
}  // namespace palpate::study

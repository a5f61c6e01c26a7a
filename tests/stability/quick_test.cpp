#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/stability/guarded_run.hpp"

/// The quick subset of the cases, each with the outcome that is expected of it.
namespace palpate::stability {
namespace {

/// Expected outcomes of the points of one name; those not named here are stable.
using Expected = std::map<std::string, std::string>;

void check(const std::vector<Point>& points, const Expected& expected) {
  ASSERT_FALSE(points.empty());
  for (const Point& p : points) {
    const Row row = run_guarded(p);
    const std::string key = p.name + "|" + p.parameter + "|" + p.value;
    const auto found = expected.find(key);
    EXPECT_EQ(row.outcome, found == expected.end() ? "stable" : found->second) << key << ": " << row.note;
    EXPECT_TRUE(std::isfinite(row.max_force) && std::isfinite(row.energy_growth)) << key;
  }
}

/// Rows of the closed loop, computed once.
class ClosedLoopCases : public ::testing::Test {
 protected:
  static const std::vector<Row>& rows() {
    static const std::vector<Row> all = [] {
      std::vector<Row> made;
      for (const Point& p : loop_points({.quick = true})) made.push_back(run_guarded(p));
      return made;
    }();
    return all;
  }
};

/// Under the controller the hand gains no more than the reserve of 10 mJ, however stiff or late; of a place sensed in
/// steps, the largest force over one step more.
TEST_F(ClosedLoopCases, KeepToTheReserveWhereTheControllerIsOn) {
  int without = 0;
  for (const Row& row : rows()) {
    EXPECT_EQ(row.outcome == "failed", row.energy_growth > 0.01)
        << row.name << " " << row.parameter << " " << row.value << ": " << row.note;
    if (row.name.find("observer") == std::string::npos) {
      const double step = row.parameter.starts_with("quantisation") ? std::stod(row.value) : 0.0;
      EXPECT_LE(row.energy_growth, 0.01 + 20 * step) << row.name << " " << row.parameter << " " << row.value;
    } else {
      without += row.energy_growth > 0.02;
    }
  }
  EXPECT_GT(without, 2) << "else the controller had nothing to do";
}

TEST_F(ClosedLoopCases, OfMovingTissueGiveTheSameRowEachTime) {
  const std::vector<Point> points = loop_points({.quick = true});
  ASSERT_EQ(rows().size(), points.size());
  int compared = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].name.starts_with("moving tissue")) continue;
    const Row& once = rows()[i];
    const Row again = run_guarded(points[i]);
    EXPECT_EQ(once.energy_growth, again.energy_growth) << once.name;
    EXPECT_EQ(once.note, again.note) << once.name;
    ++compared;
  }
  EXPECT_EQ(compared, 2);
}

// What each quick point is expected to be, where that is not plain `stable`.

TEST(StabilityCases, Materials) {
  check(material_points({.quick = true}), {{"young|E [Pa]|1e+12", "regularised"}, {"poisson|nu [1]|0.5", "refused"}});
}
TEST(StabilityCases, AMaterialIsRefusedForWhatItIs) {
  const std::vector<Point> points = material_points({.quick = true});
  const auto refused = std::ranges::find(points, "0.5", &Point::value);
  ASSERT_NE(refused, points.end());
  const Row row = run_guarded(*refused);
  EXPECT_NE(row.note.find("poisson"), std::string::npos) << row.note;
}
TEST(StabilityCases, Geometry) {
  check(geometry_points({.quick = true}), {{"units|size of the block / 0.1 m [1]|1e+06", "regularised"}});
}
TEST(StabilityCases, HeldNodes) {
  check(hold_points({.quick = true}), {{"held_nodes|adjacent|8", "regularised"},
                                       {"held_nodes|coincident|8", "regularised"},
                                       {"held_nodes|contradictory|8", "regularised"}});
}
// At 1,000 m/s the tip is on this or that side of the block, a metre apart, and the shaft upright in it: no force at
// all.
TEST(StabilityCases, PressesAndSpeeds) {
  check(press_points({.quick = true}), {{"tool_pose|tip jumps to|once around the world", "failed"},
                                        {"tool_pose|tip jumps to|out of range", "regularised"},
                                        {"tool_pose|tip jumps to|not a number", "regularised"}});
}
TEST(StabilityCases, Curves) {
  check(curve_points({.quick = true}), {{"curve|data|a force that falls", "refused"}});
}
TEST(StabilityCases, MovingTissue) {
  check(dynamic_points({.quick = true}), {{"step tensor_mass rk4|step / bound [1]|1.5", "refused"},
                                          {"step tensor_mass semi_implicit|step / bound [1]|1.5", "refused"},
                                          {"step spring_mass rk4|step / bound [1]|1.5", "refused"},
                                          {"step spring_mass semi_implicit|step / bound [1]|1.5", "refused"}});
}

// A suite of its own, as long as all others: suites run side by side.
TEST(MovingContactCases, AreStable) {
  check(moving_points({.quick = true}),
        {{"moving contact, any|combination|2: E 1.7e+04 Pa, cells 1.3 x 0.38 mm, R 2 mm, friction 1, slid, rk4 single",
          "failed"}});
}
TEST(StabilityCases, Cuts) {
  check(cut_points({.quick = true}), {});
}
TEST(StabilityCases, Hybrids) {
  check(hybrid_points({.quick = true}), {{"hybrid|step / what the bound gives about [1]|10", "refused"}});
}
TEST(StabilityCases, Shells) {
  check(shell_points({.quick = true}),
        {{"shell thickness|t/R [1]|1e-05", "refused"}, {"singular triangle|bending|polynomial", "refused"}});
}
TEST(StabilityCases, Catheters) {
  check(catheter_points({.quick = true}),
        {{"catheter semi_implicit|E [Pa]|1e+12", "refused"}, {"catheter semi_implicit|tick [s]|0.01", "refused"}});
}

}  // namespace
}  // namespace palpate::stability

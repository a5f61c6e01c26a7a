#include "tools/drive/results.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "tests/tools/program_result.hpp"

namespace palpate::drive {
namespace {

constexpr int kPoints = 4;  // of the sweep

PointResult point(int number, const std::string& young, Figures figures) {
  return {.point = number, .points = kPoints, .changes = {{"body.young", young}}, .figures = std::move(figures)};
}

TEST(DriveResults, ReadBackAsTheyWereWritten) {
  PointResult result =
      point(3, "\"a, b\"", {{"force", 0.1, ""}, {"none", std::numeric_limits<double>::quiet_NaN(), ""}});
  result.outcome = PointResult::kUnexpected;
  result.reason = "force is \xff, \"too\" small";
  const std::string line = json_line(result);
  EXPECT_EQ(line.find('\n'), line.npos);
  const PointResult back = parse_result(line);
  EXPECT_EQ(back.point, 3);
  EXPECT_EQ(back.points, kPoints);
  EXPECT_EQ(back.outcome, result.outcome);
  EXPECT_EQ(back.changes.at(0).value, "\"a, b\"");
  EXPECT_EQ(back.figures.at(0).value, 0.1);
  EXPECT_TRUE(std::isnan(back.figures.at(1).value));
  EXPECT_EQ(json_line(back), line.substr(0)) << "again";
}

TEST(DriveResults, MakeOneTableWhateverTheirOrder) {
  PointResult failed{.point = 1, .changes = {{"body.young", "5"}}, .outcome = "failed", .reason = "no, not \"so\""};
  const std::string table =
      csv_table({point(2, "6", {{"force", 2.5, ""}, {"cut", 7, ""}}), failed, point(0, "4", {{"force", 1.5, ""}})});
  EXPECT_EQ(table,
            "point,body.young,outcome,force,cut,reason\n"
            "0,4,ok,1.5,,\n"
            "1,5,failed,,,\"no, not \"\"so\"\"\"\n"
            "2,6,ok,2.5,7,\n");
}

TEST(DriveResults, OfHostileFilesAreRefusedWithTheirPlace) {
  const testing::OwnFolder folder("results");
  const auto refusal = [&](const std::string& text) {
    std::ofstream(folder / "r.jsonl") << text;
    try {
      read_results({folder / "r.jsonl"});
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("not refused");
  };
  const std::string good = json_line(point(0, "4", {{"force", 1, ""}})) + "\n";
  EXPECT_EQ(refusal(good), "not refused");
  for (const std::string& bad :
       {std::string("{"), std::string("[]"), std::string("null"), std::string("{\"point\":\"x\"}"),
        std::string("\xff\xfe"), std::string(100000, '['), good.substr(0, good.size() / 2),
        std::string("{\"point\":4,\"points\":4,\"outcome\":\"ok\",\"reason\":\"\",\"set\":{},\"figures\":{}}"),
        std::string("{\"point\":-1,\"points\":4,\"outcome\":\"ok\",\"reason\":\"\",\"set\":{},\"figures\":{}}"),
        std::string("{\"point\":1,\"points\":2000000000,\"outcome\":\"ok\",\"reason\":\"\",\"set\":{},\"figures\":{}}"),
        std::string("{\"point\":0,\"outcome\":1,\"reason\":\"\",\"set\":{},\"figures\":{}}"),
        std::string("{\"point\":0,\"outcome\":\"ok\",\"reason\":\"\",\"set\":[],\"figures\":{\"f\":\"x\"}}")})
    EXPECT_NE(refusal(good + bad).find("r.jsonl:2: no result of a run"), std::string::npos) << bad.substr(0, 80);
  EXPECT_EQ(refusal(""), "the files hold no result");
  EXPECT_THROW(read_results({folder / "none.jsonl"}), std::runtime_error);
  EXPECT_THROW(read_results({folder.path()}), std::runtime_error);
}

TEST(DriveResults, AreRequiredToBeGoodAndAll) {
  PointResult bad = point(1, "4", {});
  bad.outcome = PointResult::kUnexpected;
  bad.reason = "force is 3";
  EXPECT_NO_THROW(require_good({point(0, "4", {})}, 1));
  EXPECT_THROW(require_good({point(0, "4", {})}, 2), std::runtime_error);
  EXPECT_THROW(require_good({point(0, "4", {}), bad}, 2), std::runtime_error);
}

std::string why_not(const std::vector<PointResult>& results, std::size_t points) {
  try {
    require_good(results, points);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(DriveResults, NameThePointsThatAreMissing) {
  EXPECT_EQ(points_of({point(1, "5", {}), point(3, "7", {})}), 4u);
  EXPECT_EQ(why_not({point(1, "5", {}), point(3, "7", {})}, 4), "2 of 4 points are missing: 0, 2");
  const PointResult alone{.point = 0};
  EXPECT_EQ(points_of({alone, alone}), 0u);
  EXPECT_EQ(why_not({alone, alone}, 0), "") << "runs alone are of no sweep";
  PointResult of_another = point(0, "4", {});
  of_another.points = 7;
  EXPECT_THROW(points_of({point(1, "5", {}), of_another}), std::runtime_error);
}

TEST(DriveResults, ToldTwiceAreOneUnlessTheyDiffer) {
  std::vector<PointResult> results{point(0, "4", {{"force", 1, ""}, {"wall", 2, "s"}}),
                                   point(0, "4", {{"force", 1, ""}, {"wall", 3, "s"}})};
  EXPECT_EQ(drop_repeated(results), std::vector<std::string>{"point 0 has two results, which are equal: one is kept"});
  EXPECT_EQ(results.size(), 1u);

  PointResult failed = point(0, "4", {});
  failed.outcome = PointResult::kFailed;
  results = {failed, point(0, "4", {{"force", 1, ""}})};
  EXPECT_EQ(drop_repeated(results).size(), 1u);
  ASSERT_EQ(results.size(), 1u);
  EXPECT_TRUE(results[0].good()) << "it was made again";

  results = {point(0, "4", {{"force", 1, ""}}), point(0, "4", {{"force", 2, ""}}), point(1, "4", {{"force", 1, ""}})};
  EXPECT_TRUE(drop_repeated(results).empty());
  EXPECT_EQ(results.size(), 3u);
  EXPECT_NE(why_not(results, 2).find("points with several results that differ, a row for each: 0"), std::string::npos);
}

TEST(DriveResults, AreHeldToWhatIsExpectedOfThem) {
  PointResult failed = point(2, "6", {});
  failed.outcome = PointResult::kFailed;
  std::vector<PointResult> results{point(0, "4", {{"tool.a.force.max", 1, ""}}),
                                   point(1, "5", {{"tool.a.force.max", 3, ""}}), failed, point(3, "7", {})};
  expect_of(results, {parse_expectation("tool.force.max<2")});
  EXPECT_TRUE(results[0].good());
  EXPECT_EQ(results[1].outcome, PointResult::kUnexpected);
  EXPECT_EQ(results[1].reason, "tool.a.force.max is 3, expected <2");
  EXPECT_EQ(results[2].outcome, PointResult::kFailed);
  EXPECT_EQ(results[3].outcome, PointResult::kFailed) << "as in a run of a scene without the figure";
  EXPECT_THROW(expect_of(results, {parse_expectation("tool.force.mex<2")}), std::runtime_error);
}

}  // namespace
}  // namespace palpate::drive

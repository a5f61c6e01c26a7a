#include "tools/drive/results.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "tests/tools/program_result.hpp"

namespace palpate::drive {
namespace {

PointResult point(int number, const std::string& young, Figures figures) {
  return {.point = number, .changes = {{"body.young", young}}, .figures = std::move(figures)};
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

}  // namespace
}  // namespace palpate::drive

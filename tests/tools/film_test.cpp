// Films of logs: every picture that is due.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/bus/log_reader.hpp"
#include "common/bus/log_writer.hpp"
#include "idl/topics.hpp"
#include "tests/tools/comes_within.hpp"
#include "tests/tools/program_result.hpp"
#include "tests/tools/unnamed_file.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using testing::LoopbackScene;
using testing::OwnFolder;
using testing::program;
using testing::run_program;

class ToolsFilm : public ::testing::Test {
 protected:
  /// A log without pictures and without anybody's status, of a second; its scene is gone afterwards.
  static void SetUpTestSuite() {
    folder_ = std::make_unique<OwnFolder>("film");
    const LoopbackScene scene("film-scene", testing::kLinear);
    const auto run = run_program(fmt::format("{} drive {} --seconds 1.1 --log {}", program("palpate"), scene.scene(),
                                             (*folder_ / "a.lcmlog").string()));
    ASSERT_EQ(run.status, 0) << run.err;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static fs::path film(const std::string& name) { return *folder_ / (name + ".mp4"); }
  static testing::ProgramResult draw(const std::string& name, const std::string& more = "") {
    return run_program(fmt::format("{} film {} -o {} --width 160 --height 120 --samples 1 {}", program("palpate"),
                                   (*folder_ / "a.lcmlog").string(), film(name).string(), more));
  }
  /// As ffprobe counts them, decoding each.
  static int pictures(const std::string& name) {
    const auto counted = run_program(
        "ffprobe -v error -count_frames -select_streams v:0 -show_entries stream=nb_read_frames -of csv=p=0 " +
        film(name).string());
    return std::atoi(counted.out.c_str());
  }

  /// Its grey values, one picture of the film.
  static std::string picture(const std::string& name, int number) {
    const auto raw = (*folder_ / "picture.gray").string();
    run_program(
        fmt::format("ffmpeg -v error -y -i {} -vf \"select=eq(n\\,{})\" -frames:v 1 -f rawvideo -pix_fmt gray {}",
                    film(name).string(), number, raw));
    return testing::text_of(raw);
  }
  /// How many grey values differ by more than what packing a film changes.
  static int apart(const std::string& a, const std::string& b) {
    EXPECT_EQ(a.size(), b.size());
    int count = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      count += std::abs(static_cast<unsigned char>(a[i]) - static_cast<unsigned char>(b[i])) > 40;
    return count;
  }

  static std::unique_ptr<OwnFolder> folder_;
};
std::unique_ptr<OwnFolder> ToolsFilm::folder_;

TEST_F(ToolsFilm, EveryPictureIsDrawnAndTheSameBytesComeAgain) {
  const auto first = draw("first", "--still " + (*folder_ / "still.png").string());
  ASSERT_EQ(first.status, 0) << first.err;
  ASSERT_EQ(draw("again").status, 0);
  EXPECT_EQ(testing::text_of(film("first")), testing::text_of(film("again")));
  EXPECT_TRUE(fs::exists(*folder_ / "still.png"));
  EXPECT_NEAR(pictures("first"), 30 * 1.1 + 1, 1);
  EXPECT_EQ(first.out.find("largest force 0.00 N"), std::string::npos) << first.out;
}

TEST_F(ToolsFilm, ItIsAsSlowAndAsLongAsAskedFor) {
  const auto slow = draw("slow", "--from 0.1 --to 0.3 --speed 0.1");
  ASSERT_EQ(slow.status, 0) << slow.err;
  EXPECT_EQ(pictures("slow"), 61);
}

TEST_F(ToolsFilm, ItsFiguresArePrintedAsOneLineOfJson) {
  const auto drawn = draw("figures", "--from 0.7 --to 0.9 --json");
  ASSERT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_EQ(std::ranges::count(drawn.out, '\n'), 1) << drawn.out;
  const auto figures = nlohmann::json::parse(drawn.out);
  EXPECT_EQ(figures["film"], film("figures").string());
  EXPECT_EQ(figures["pictures"], pictures("figures"));
  EXPECT_NEAR(figures["seconds"].get<double>(), 0.2, 0.05);
  EXPECT_GT(figures["force_max_n"].get<double>(), 0.01);
}

TEST_F(ToolsFilm, AStretchShowsWhatTheWholeFilmShowsThen) {
  ASSERT_EQ(draw("whole").status, 0);
  ASSERT_EQ(draw("stretch", "--from 0.5 --to 0.8").status, 0);
  const std::string begin = picture("stretch", 0);
  ASSERT_EQ(begin.size(), 160u * 120);
  const int whole_way = apart(picture("whole", 0), picture("whole", 15));
  EXPECT_GT(whole_way, 20);
  EXPECT_LT(apart(begin, picture("whole", 15)), whole_way / 4) << whole_way;
}

// A recorder that came three seconds before the scene.
TEST_F(ToolsFilm, TimesCountFromTheScenesFirstStep) {
  const LoopbackScene scene("film-early", testing::kLinear);
  const auto on_time = *folder_ / "on_time.lcmlog", early = *folder_ / "early.lcmlog";
  ASSERT_EQ(run_program(
                fmt::format("{} drive {} --seconds 1.1 --log {}", program("palpate"), scene.scene(), on_time.string()))
                .status,
            0);
  {
    LogReader reader(on_time);
    LogWriter writer(early, std::size_t{1} << 30);
    constexpr std::int64_t kEarly = 3'000'000'000;
    LogEvent event;
    std::int64_t earlier = kEarly;  // up to the first step
    for (bool first = true; reader.next(event); first = false) {
      if (first) writer.write(kHeaderChannel, event.receive_ns - kEarly, reader.header());
      if (event.channel == topics::tool_state.name) earlier = 0;
      writer.write_payload(event.channel, event.receive_ns - earlier, event.payload);
    }
    writer.finish();
  }
  for (const std::string name : {"on_time", "early"}) {
    const auto drawn =
        run_program(fmt::format("{} film {}.lcmlog -o {} --width 160 --height 120 --samples 1 --from 0.5 "
                                "--to 0.8",
                                program("palpate"), (*folder_ / name).string(), film(name).string()));
    ASSERT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_EQ(drawn.err.find("the haptic node is gone"), std::string::npos) << drawn.err;
  }
  EXPECT_EQ(pictures("on_time"), pictures("early"));
  EXPECT_GT(apart(picture("on_time", 0), picture("on_time", 9)), 20);
  for (const int number : {0, 9}) EXPECT_LT(apart(picture("on_time", number), picture("early", number)), 5) << number;
}

TEST_F(ToolsFilm, WhatIsNotThereIsRefused) {
  const auto late = draw("late", "--from 5");
  EXPECT_EQ(late.status, 1);
  EXPECT_NE(late.err.find("the log has 0.00 s to 1."), std::string::npos) << late.err;
  EXPECT_FALSE(fs::exists(film("late")));
}

TEST_F(ToolsFilm, AReportHasTheSessionsSideBySide) {
  const std::string log = *folder_ / "a.lcmlog", folder = *folder_ / "report";
  const auto made =
      run_program(fmt::format("{} report {} {} -o {} --pictures 2", program("palpate"), log, log, folder));
  ASSERT_EQ(made.status, 0) << made.err;
  const auto sessions = nlohmann::json::parse(testing::text_of(folder + "/report.json"))["sessions"];
  ASSERT_EQ(sessions.size(), 2u);
  const auto& tool = sessions[0]["tools"][0];
  EXPECT_EQ(tool, sessions[1]["tools"][0]);
  EXPECT_NEAR(tool["seconds"].get<double>(), 1.1, 0.01);
  EXPECT_GT(tool["force_max_n"].get<double>(), 0.01);
  EXPECT_NEAR(tool["path_m"].get<double>(), 0.028, 0.003);  // down to the block and into it
  EXPECT_EQ(tool["touches"], 1);
  EXPECT_EQ(sessions[1]["pictures"].size(), 2u);
  EXPECT_TRUE(fs::exists(folder + "/picture_1_1.png"));
  const std::string page = testing::text_of(folder + "/index.html");
  EXPECT_NE(page.find("largest force"), std::string::npos) << made.err;
  EXPECT_EQ(page.find("src=\"http"), std::string::npos);
}

TEST_F(ToolsFilm, ItsLargestForceIsThatOfTheReport) {
  const std::string log = *folder_ / "a.lcmlog", folder = *folder_ / "force";
  const auto made = run_program(fmt::format("{} report {} -o {} --pictures 0", program("palpate"), log, folder));
  ASSERT_EQ(made.status, 0) << made.err;
  const auto drawn = draw("force", "--from 1.08 --rate 240 --speed 0.02 --json");
  ASSERT_EQ(drawn.status, 0) << drawn.err;
  const auto report = nlohmann::json::parse(testing::text_of(folder + "/report.json"));
  const double largest = report["sessions"][0]["tools"][0]["force_max_n"];
  EXPECT_NEAR(nlohmann::json::parse(drawn.out)["force_max_n"].get<double>(), largest, 1e-3 * largest);
}

TEST_F(ToolsFilm, OfAReportThatIsStoppedNothingIsLeft) {
  const std::string folder = *folder_ / "stopped_report";
  ChildProcess making("palpate",
                      {program("palpate"), "report", *folder_ / "a.lcmlog", "-o", folder, "--pictures", "100"});
  ASSERT_TRUE(testing::comes_within(30s, [&] { return fs::exists(folder + "/picture_0_0.png"); }));
  making.interrupt();
  ASSERT_TRUE(making.wait(30s));
  EXPECT_EQ(making.status(), 130);
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(ToolsFilm, AReportOfALogThatIsNotThereMakesNoFolder) {
  const std::string folder = *folder_ / "none";
  EXPECT_EQ(run_program(fmt::format("{} report {}.lcmlog -o {}", program("palpate"), folder, folder)).status, 1);
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(ToolsFilm, StoppedByCtrlCThereIsNoFilm) {
  const fs::path said = *folder_ / "said";
  ChildProcess drawing(
      "palpate", {"/bin/sh", "-c",
                  fmt::format("exec {} film {} -o {} --speed 0.01 --width 640 --height 480 2>{}", program("palpate"),
                              (*folder_ / "a.lcmlog").string(), film("stopped").string(), said.string())});
  ASSERT_TRUE(
      testing::comes_within(30s, [&] { return testing::bytes_on_the_way(drawing.pid(), folder_->path()) > 0; }));
  drawing.interrupt();
  ASSERT_TRUE(drawing.wait(30s));
  EXPECT_EQ(drawing.status(), 130);
  EXPECT_NE(testing::text_of(said).find("stopped.mp4: stopped before its end"), std::string::npos)
      << testing::text_of(said);
  for (const auto& file : fs::directory_iterator(folder_->path()))
    EXPECT_FALSE(file.path().filename().string().starts_with("stopped")) << file.path() << " is left of it";
}

}  // namespace
}  // namespace palpate

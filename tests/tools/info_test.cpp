#include <nlohmann/json.hpp>

#include "common/bus/log_writer.hpp"
#include "idl/topics.hpp"
#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

using namespace testing;

TEST(Info, TellsHowTheTaskOfALogEnded) {
  const OwnFolder folder("info");
  const std::string log = folder / "task.lcmlog";
  {
    LogWriter writer(log);
    LogHeader header;
    header.schema = schema_text();
    writer.write(kHeaderChannel, 1, header);
    for (const std::uint64_t seq : {1u, 2u})
      writer.write(topics::task_record.name, static_cast<std::int64_t>(100'000'000 * seq),
                   TaskRecord{.body = 1,
                              .run = 0xAB,
                              .seq = seq,
                              .inserted = 0.01,
                              .deepest = 0.011 * static_cast<double>(seq),
                              .inserting_s = 6.5,
                              .max_force = 0.75,
                              .wall_contacts = 3,
                              .grasps = 2,
                              .drops = 1,
                              .held_s = 5.25});
    writer.finish();
  }
  const ProgramResult text = run_program(program("palpate") + " info " + log);
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("task of catheter 1 in run 00000000000000ab\n"
                          "inserted 10.0 mm, deepest 22.0 mm, reached in 6.5 s, held for 5.2 s\n"
                          "largest force 0.75 N, wall contacts 3, grasps 2, drops 1\n"),
            std::string::npos)
      << text.out;
  const ProgramResult json = run_program(program("palpate") + " info --json " + log);
  EXPECT_EQ(json.status, 0) << json.err;
  const auto tasks = nlohmann::json::parse(json.out)["tasks"];
  ASSERT_EQ(tasks.size(), 1u);
  EXPECT_EQ(tasks[0]["seq"], 2);
  EXPECT_EQ(tasks[0]["deepest"], 0.022);
}

TEST(Info, TellsAScenesTitleThatItHasNoneAndThatThereIsNoScene) {
  const OwnFolder folder("info-scene");
  const auto said_of = [&](const std::string& scene) {
    const std::string log = folder / "scene.lcmlog";
    LogWriter writer(log);
    LogHeader header;
    header.schema = schema_text();
    writer.write(kHeaderChannel, 1, header);
    if (!scene.empty()) writer.write(topics::scene.name, 2, SceneText{.seq = 1, .scene_hash = "a", .text = scene});
    writer.finish();
    return run_program(program("palpate") + " info " + log).out;
  };
  EXPECT_NE(said_of("title = \"a block\"\n").find("scene     a block\n"), std::string::npos);
  EXPECT_NE(said_of("[[body]]\n").find("scene     without a title\n"), std::string::npos);
  EXPECT_NE(said_of("").find("scene     none in the log\n"), std::string::npos);
}

// What is lost on the way lacks its sequence number, and is counted as missing.
TEST(Info, StepsThatTheHapticNodeToldNobodyAreNamed) {
  const OwnFolder folder("info-untold");
  const std::string log = folder / "untold.lcmlog";
  {
    LogWriter writer(log);
    LogHeader header;
    header.schema = schema_text();
    writer.write(kHeaderChannel, 1, header);
    for (std::uint64_t step = 0, seq = 1; step < 100; ++step) {
      if (step >= 40 && step < 65) continue;  // no message was made
      if (seq != 20)                          // one was lost
        writer.write(topics::tool_state.name, static_cast<std::int64_t>(1'000'000 * step),
                     ToolState{.run = 5, .seq = seq, .step = step});
      ++seq;
    }
    writer.finish();
  }
  const auto json = nlohmann::json::parse(run_program(program("palpate") + " info --json " + log).out);
  EXPECT_EQ(json["untold_steps"], 25);
  EXPECT_EQ(json["topics"]["palpate/tool_state"]["missing"], 1);
  const ProgramResult text = run_program(program("palpate") + " info " + log);
  EXPECT_NE(text.out.find("lacks 25 steps that its haptic node told nobody"), std::string::npos) << text.out;
}

TEST(Info, ASenseInTheFutureIsTold) {
  const OwnFolder folder("info-ahead");
  const std::string log = folder / "ahead.lcmlog";
  {
    LogWriter writer(log);
    writer.write(kHeaderChannel, 1, LogHeader{.schema = schema_text()});
    for (std::uint64_t seq = 1; seq <= 10; ++seq)
      writer.write(topics::force_state.name, static_cast<std::int64_t>(1'000'000 * seq),
                   ForceState{.run = 5, .seq = seq, .step = seq, .sense_ns = 5'000'000, .publish_ns = 4'000'000});
    writer.finish();
  }
  const ProgramResult text = run_program(program("palpate") + " info " + log);
  EXPECT_NE(text.out.find("palpate/force_state: 4 of 10 say that they were sensed after they were received"),
            std::string::npos)
      << text.out;
  EXPECT_NE(text.out.find("10 of these say that they were written before their step was sensed"), std::string::npos)
      << text.out;
  const auto json = nlohmann::json::parse(run_program(program("palpate") + " info --json " + log).out);
  EXPECT_EQ(json["topics"]["palpate/force_state"]["ahead"], 4);
  EXPECT_EQ(json["hops_us"]["ahead"], 10);
}

TEST(Info, ALogsWordsReachNoTerminalAsCommands) {
  const OwnFolder folder("info-words");
  const std::string log = folder / "words.lcmlog";
  {
    LogWriter writer(log);
    LogHeader header;
    header.schema = schema_text();
    header.host = "here\x1b[2J";
    header.version = "1\x1b]0;title\x07";
    header.scene = "title = \"pale\x1b[8m liver, mürb\"\n";
    writer.write(kHeaderChannel, 1, header);
    writer.finish();
  }
  const ProgramResult text = run_program(program("palpate") + " info " + log);
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_EQ(text.out.find_first_of("\x1b\x07"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("on here?[2J by version 1?]0;title?"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("mürb"), std::string::npos) << text.out;
}

}  // namespace
}  // namespace palpate

#include "common/bus/codec.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "common/bus/log_format.hpp"
#include "common/bus/print.hpp"
#include "common/bus/task_figures.hpp"
#include "tests/bus/messages_for_tests.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

TEST(Codec, DecodingGivesBackEveryMessage) {
  for_each_message([]<class M>(const M& message) {
    Bytes bytes;
    encode(message, bytes);
    M back;
    ASSERT_TRUE(decode(bytes, back)) << schema_line<M>();
    EXPECT_TRUE(message == back) << schema_line<M>();
    EXPECT_FALSE(message == M()) << schema_line<M>();
  });
}

TEST(Codec, EveryShorterOrLongerTextIsRefused) {
  for_each_message([]<class M>(const M& message) {
    Bytes bytes;
    encode(message, bytes);
    M back;
    for (std::size_t size = 0; size < bytes.size(); ++size)
      ASSERT_FALSE(decode(std::span(bytes).first(size), back)) << schema_line<M>() << size;
    bytes.push_back(0);
    EXPECT_FALSE(decode(bytes, back)) << schema_line<M>();
  });
}

TEST(Codec, ACountBeyondTheTextAllocatesNothing) {
  SurfaceState surface;
  Bytes bytes;
  encode(surface, bytes);
  std::fill(bytes.end() - 8, bytes.end(), 0xFF);
  SurfaceState back;
  EXPECT_FALSE(decode(bytes, back));
  EXPECT_EQ(back.position.capacity(), 0u);

  LocalContactModel model;
  Bytes longer;
  encode(model, longer);
  std::fill(longer.end() - 12, longer.end() - 8, 0xFF);  // the last sequence's count, before publish_ns
  LocalContactModel model_back;
  EXPECT_FALSE(decode(longer, model_back));
  EXPECT_EQ(model_back.triangles.capacity(), 0u);
}

TEST(Codec, NumbersAreLittleEndianAndUnpadded) {
  Bytes bytes;
  encode(DeviceState{0x01020304, 5, 6, 0, 0, 0, 0, 1.0, 0, 0}, bytes);
  ASSERT_EQ(bytes.size(), 4u + 8 + 8 + 6 * 8 + 8);
  EXPECT_EQ(bytes[0], 4);
  EXPECT_EQ(bytes[3], 1);
  EXPECT_EQ(bytes[4], 5);
  EXPECT_EQ(bytes[59], 0x3F);
  EXPECT_EQ(bytes[58], 0xF0);
}

TEST(Codec, TheSchemaSpellsOutFieldsAndTopics) {
  EXPECT_EQ(schema_line<NodalForce>(), "NodalForce: body u32, node u32, force f64[3]\n");
  EXPECT_NE(schema_text().find("forces NodalForce[], contacts HeldContact[], publish_ns i64\n"), std::string::npos);
  EXPECT_NE(schema_text().find("topic palpate/held_contacts ContactState\n"), std::string::npos);
}

TEST(Codec, ASchemaIsTheSameInAnotherOrderOfItsLinesAlone) {
  EXPECT_TRUE(same_schema("A: x u8\nB: y u8\n", "B: y u8\nA: x u8\n"));
  EXPECT_FALSE(same_schema("A: x u8\nB: y u8\n", "A: y u8\nB: x u8\n"));
  EXPECT_FALSE(same_schema("A: x u8\nB: y u8\n", "A: x u8\n"));
}

TEST(Print, JsonReadsBackWithEveryValue) {
  for_each_message([]<class M>(const M& message) {
    const auto json = nlohmann::json::parse(to_json(message));
    fields([&](const char* name,
               const auto& field) { EXPECT_EQ(json.at(name).dump(), nlohmann::json::parse(to_json(field)).dump()); },
           message);
  });
  const auto json = nlohmann::json::parse(to_json(status_sample()));
  EXPECT_EQ(json["text"], status_sample().text);
  EXPECT_EQ(json["rate_hz"].get<double>(), 999.5);
  const auto contact = nlohmann::json::parse(to_json(contact_sample(2)));
  EXPECT_EQ(contact["contacts"][1]["nodes"][2].get<int>(), 3);
}

TEST(Print, ATaskRecordIsTwoLinesForTheTrainee) {
  const auto [reached, how] = task_lines(task_sample());
  EXPECT_EQ(reached, "inserted 10.0 mm, deepest 20.0 mm, reached in 3.5 s, held for 9.5 s");
  EXPECT_EQ(how, "largest force 0.25 N, wall contacts 6, grasps 7, drops 8");
}

TEST(Print, EveryFieldOfATaskRecordThatIsNoStampIsAFigureOfIt) {
  const std::set<std::string> stamps{"body", "run", "seq", "step", "sense_ns", "publish_ns"};
  const TaskRecord task = task_sample();
  std::set<double> in_message, told;
  fields(
      [&](const char* name, const auto& field) {
        if (!stamps.contains(name)) in_message.insert(static_cast<double>(field));
      },
      task);
  for (const TaskFigure& figure : task_figures()) told.insert(figure.of(task));
  EXPECT_EQ(told, in_message);
}

TEST(Print, CsvHasAsManyCellsAsColumns) {
  EXPECT_EQ(csv_header<ForceState>(),
            "tool,run,seq,step,sense_ns,force_0,force_1,force_2,torque_0,torque_1,torque_2,yaw_torque,"
            "pitch_torque,depth_force,roll_torque,grip,trocar_0,trocar_1,trocar_2,energy,flags,publish_ns");
  EXPECT_EQ(csv_row(force_sample()), "2,3,4,5,6,0.5,-1,2,0.01,0.02,-0.03,0.1,0.2,0.3,0.4,0.04,7,-8,9,0.25,5,7");
  NodeStatus status;
  status.node = "a \"b\", c";
  EXPECT_EQ(csv_row(status).substr(0, 13), "\"a \"\"b\"\", c\",");
}

}  // namespace
}  // namespace palpate

#include "tools/mcap/cdr.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(Cdr, AlignsEachNumberToItsSize) {
  SceneText m{.run = 0x0102030405060708, .seq = 2, .scene_hash = "ab", .text = "", .code_path = "c", .publish_ns = -1};
  Bytes bytes;
  cdr::encode(m, bytes);
  const Bytes expected{0,   1,   0,   0,                                               // version 1, little-endian
                       8,   7,   6,   5,   4,   3,   2,   1,  2, 0, 0, 0, 0, 0, 0, 0,  // run, seq
                       3,   0,   0,   0,   'a', 'b', 0,   0,  // with its zero, and one byte up to
                       1,   0,   0,   0,   0,   0,   0,   0,  // an empty string, three bytes up to
                       2,   0,   0,   0,   'c', 0,   0,   0,  // and two up to
                       255, 255, 255, 255, 255, 255, 255, 255};
  EXPECT_EQ(bytes, expected);
}

TEST(Cdr, SequencesOfStructsAreAlignedWithin) {
  ContactState m{.tool = 1};
  m.forces.push_back({.body = 2, .node = 3, .force = {1, 0, 0}});
  Bytes bytes;
  cdr::encode(m, bytes);
  // tool, padding, run, seq, step, sense_ns, press, count, then body and node up to a multiple of 8.
  const std::size_t forces = 4 + 8 + 4 * 8 + 3 * 8;
  ASSERT_GT(bytes.size(), forces + 4 + 8 + 8);
  EXPECT_EQ(bytes[forces], 1);
  EXPECT_EQ(bytes[forces + 4], 2);
  EXPECT_EQ(bytes[forces + 8], 3);
  double force = 0;
  std::memcpy(&force, bytes.data() + forces + 16, sizeof force);
  EXPECT_EQ(force, 1) << "behind four bytes of padding";
}

TEST(Cdr, TypesAreToldWithThoseThatTheyAreMadeOf) {
  const std::string text = cdr::idl<ContactState>();
  const std::size_t part = text.find(
      "  @final struct NodalForce {\n    unsigned long body;\n    unsigned long node;\n"
      "    double force[3];\n  };\n");
  const std::size_t whole =
      text.find("  @final struct ContactState {\n    unsigned long tool;\n    unsigned long long run;\n");
  EXPECT_LT(part, whole) << text;
  EXPECT_NE(
      text.find("    sequence<NodalForce> forces;\n    sequence<HeldContact> contacts;\n    long long publish_ns;\n"),
      text.npos)
      << text;
  EXPECT_EQ(text.find("NodalForce {"), text.rfind("NodalForce {")) << "once";
}

}  // namespace
}  // namespace palpate

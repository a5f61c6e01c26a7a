#include "common/describe/printable.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

using namespace std::string_literals;

TEST(Printable, LettersOfEveryScriptStayAsTheyAre) {
  for (const char* text : {"", "liver of 1.5 kg", "Leber, mürb: 3 µm", "печень", "肝臓", "𝛼"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, NothingReachesATerminalThatItCouldObey) {
  EXPECT_EQ(printable("a\x1b[2Jb\n\r\t\x7f"), "a?[2Jb????");
  EXPECT_EQ(printable("zero\0end"s), "zero?end");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            "?2J")
      << "an escape sequence in one character";
  EXPECT_EQ(printable("\u202egnp.exe"), "?gnp.exe") << "turns the direction of writing";
  EXPECT_EQ(printable("a\u200bb\u2028c\ufeff"), "a?b?c?");
}

TEST(Printable, BytesThatAreNoTextAreMarkedOneByOne) {
  EXPECT_EQ(printable("\xff\xfe"), "??");
  EXPECT_EQ(printable("\xc3"), "?") << "cut off";
  EXPECT_EQ(printable("\xc0\xaf"), "??") << "longer than needed";
  EXPECT_EQ(printable("\xed\xa0\x80"), "???") << "half of a pair";
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "????") << "beyond the last";
}

}  // namespace
}  // namespace palpate

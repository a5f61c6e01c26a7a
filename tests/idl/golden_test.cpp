#include <gtest/gtest.h>

#include <filesystem>

#include "tests/idl/text_of.hpp"

/// What the generator writes for the toy, word for word. After a change on purpose, the text below
/// "toy_golden.txt should be" is the new file.
namespace palpate {
namespace {

using testing::text_of;

TEST(ToyIdl, ComesOutWordForWord) {
  std::string written;
  for (const char* name :
       {"messages.hpp", "fields.hpp", "limits.hpp", "limits.cpp", "topics.hpp", "dds_types.hpp", "topics.md"})
    written.append("== ").append(name).append("\n").append(text_of(std::filesystem::path(PALPATE_TOY_WRITTEN) / name));
  EXPECT_EQ(written, text_of(PALPATE_TOY_GOLDEN)) << "toy_golden.txt should be\n" << written;
}

}  // namespace
}  // namespace palpate

#include "common/files/file_kind.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace palpate {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

TEST(FileKind, IsToldByTheFirstBytes) {
  const fs::path file = fs::temp_directory_path() / fmt::format("palpate-kind-{}", getpid());
  const auto kind = [&](const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
    return kind_of(file);
  };
  EXPECT_EQ(kind("\xed\xa1\xda\x01\0\0"s), ".lcmlog");
  EXPECT_EQ(kind("\0\0\0 ftypisom"s), ".mp4");
  EXPECT_EQ(kind("\x89PNG\r\n"), ".png");
  EXPECT_EQ(kind("$MeshFormat\n4.1 0 8\n"), ".msh");
  EXPECT_EQ(kind("#INRIMAGE-4#{\nXDIM=3\n"), ".inr");
  EXPECT_EQ(kind("ObjectType = Image\n"), ".mha");
  EXPECT_EQ(kind("NRRD0004\n"), ".nrrd");
  EXPECT_EQ(kind(std::string(80, '\x7f') + "\1\0\0\0"s + std::string(50, '\1')), ".stl");
  EXPECT_EQ(kind("<?xml version=\"1.0\"?>"), ".vtu");
  EXPECT_EQ(kind("{\"a\": 1}\n"), ".json");
  EXPECT_EQ(kind("# a motion\ntime,yaw\n0,1\n"), "motion");
  EXPECT_EQ(kind("\xef\xbb\xbftime,yaw\n0,1\n"), "motion");
  EXPECT_EQ(kind("\xef\xbb\xbf[[body]]\n"), ".toml");
  EXPECT_EQ(kind("# of nodes\nnode,x\n0,1\n"), ".csv");
  EXPECT_EQ(kind("# of the liver\n\ntitle = \"x, y\"\n"), ".toml");
  EXPECT_EQ(kind("[[body]]\n"), ".toml");
  EXPECT_EQ(kind("\x7f"
                 "ELF\2\1\1\0"s),
            "");
  EXPECT_EQ(kind(""), "");
  fs::remove(file);
  EXPECT_EQ(kind_of(file), "");
  EXPECT_EQ(kind_in_words(".lcmlog"), "a topic log");
  EXPECT_EQ(kind_in_words(""), "something else");
}

}  // namespace
}  // namespace palpate

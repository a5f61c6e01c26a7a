#include <csignal>
#include <random>

#include "common/mesh/child.hpp"
#include "common/mesh/mesh_file.hpp"
#include "tests/mesh/literal_files.hpp"
#include "tests/mesh/mesh_test_helpers.hpp"

// Damaged files end in a mesh or in one sentence that names the file: never in a crash of this process.
namespace palpate {
namespace {

struct Sample {
  std::string name, bytes;
};

std::vector<Sample> samples() {
  return {{"a.msh", kGmsh1},
          {"b.msh", kGmsh2},
          {"c.msh", gmsh2_binary()},
          {"d.msh", kGmsh4},
          {"e.msh", gmsh4_binary()},
          {"f.vtk", kVtk},
          {"g.vtk", vtk_binary<double>("double")}};
}

void expect_mesh_or_sentence(const std::filesystem::path& file) {
  const std::string text = sentence_of([&] { check_tet_mesh(load_tet_mesh(file, 1), "after loading"); });
  EXPECT_TRUE(text.empty() || text.starts_with(file.string() + ": ")) << text;
  const std::string surface = sentence_of([&] { load_triangle_mesh(file, 1); });
  EXPECT_TRUE(surface.empty() || surface.starts_with(file.string() + ": ")) << surface;
}

TEST(DamagedFile, CutAnywhereIsRefused) {
  const TestFolder folder;
  for (const Sample& sample : samples()) {
    for (std::size_t size = 0; size + 12 < sample.bytes.size(); size += 5) {
      const auto file = folder.write(sample.name, sample.bytes.substr(0, size));
      const std::string text = sentence_of([&] { load_tet_mesh(file, 1); });
      EXPECT_TRUE(text.starts_with(file.string() + ": ")) << sample.name << " cut at " << size << ": " << text;
    }
  }
}

TEST(DamagedFile, WithFlippedBytesIsReadOrRefusedInWords) {
  const TestFolder folder;
  std::mt19937 random(1);
  for (const Sample& sample : samples()) {
    for (int round = 0; round < 60; ++round) {
      std::string bytes = sample.bytes;
      for (int flips = 1 + round % 3; flips > 0; --flips)
        bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
      expect_mesh_or_sentence(folder.write(sample.name, bytes));
    }
  }
}

TEST(DamagedFile, OfRealSizeWithFlippedBytesIsReadOrRefusedInWords) {
  const TestFolder folder;
  const TetMesh liver = load_tet_mesh(PALPATE_SOURCE "/scenes/meshes/liver.msh", 1);
  std::mt19937 random(2);
  for (const auto& [name, format] :
       {std::pair{"a.msh", MshFormat{4.1, true}}, {"b.msh", MshFormat{2.2, true}}, {"c.vtk", MshFormat{4.1, true}}}) {
    write_tet_mesh(liver, folder.path(name), format);
    const std::string good = bytes_of(folder.path(name));
    for (int round = 0; round < 12; ++round) {
      std::string bytes = good;
      for (int flips = 0; flips < 20; ++flips)
        bytes[random() % (round % 2 ? bytes.size() : 3000)] ^= static_cast<char>(random() % 256);
      expect_mesh_or_sentence(folder.write(name, bytes));
    }
  }
}

TEST(Child, ReturnsBytesAndPassesReasonsOn) {
  EXPECT_EQ(run_in_child([] { return std::string("a\0b", 3); }), std::string("a\0b", 3));
  EXPECT_EQ(sentence_of([] { run_in_child([]() -> std::string { throw std::runtime_error("no good"); }); }), "no good");
  EXPECT_EQ(sentence_of([] { run_in_child([]() -> std::string { throw std::string("no string"); }); }), "no string");
}

TEST(Child, ThatCrashesOrLeavesIsReportedInWords) {
  EXPECT_EQ(sentence_of([] {
              run_in_child([]() -> std::string {
                raise(SIGSEGV);
                return "";
              });
            }),
            "the reader crashed (signal 11)");
  EXPECT_EQ(sentence_of([] { run_in_child([]() -> std::string { _exit(0); }); }), "the reader ended without an answer");
  EXPECT_EQ(sentence_of([] { run_in_child([]() -> std::string { _exit(3); }); }), "the reader ended without an answer");
}

TEST(Child, CannotWriteToTheTerminal) {
  ::testing::internal::CaptureStdout();
  run_in_child([] {
    puts("chatter");
    fflush(stdout);
    return std::string();
  });
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace palpate

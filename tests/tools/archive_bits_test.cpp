// An archive is the same file, byte for byte, however many threads OpenBLAS has.
#include <gtest/gtest.h>

#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

using testing::OwnFolder;
using testing::program;
using testing::run_program;

struct Precomputed {
  const char* name;
  std::string arguments;  ///< scene and options

  friend void PrintTo(const Precomputed& p, std::ostream* out) { *out << p.name; }
};

std::string example(const std::string& scene) {
  return PALPATE_SOURCE "/scenes/" + scene;
}

const std::vector<Precomputed> kBodies{
    {"linear", example("plate.toml") + " --set \"body.offline={element=\\\"p1\\\"}\""},
    {"tensor_mass", example("cylinder_tear.toml")},
    {"spring_mass", example("cylinder_tear.toml") + " --set body.model=spring_mass"},
    {"hybrid", example("cylinder_hybrid.toml")},
    {"hybrid_of_two_meshes", example("block_partial.toml")},
    {"modal_shell", example("duct_poke.toml")}};

/// Computed into a folder that has none yet, which it leaves as it was but for the readings of meshes.
std::string archive_of(const std::string& arguments, const OwnFolder& cache, int threads) {
  const auto done = run_program(fmt::format("OPENBLAS_NUM_THREADS={} PALPATE_CACHE={} {} precompute {}", threads,
                                            cache.path().string(), program("palpate"), arguments));
  EXPECT_EQ(done.status, 0) << done.err;
  std::vector<std::filesystem::path> archives;
  for (const auto& entry : std::filesystem::directory_iterator(cache.path()))
    if (entry.path().extension() == ".h5") archives.push_back(entry.path());
  EXPECT_EQ(archives.size(), 1u);
  if (archives.empty()) return {};
  std::string bytes = testing::text_of(archives[0]);
  std::filesystem::remove(archives[0]);
  return bytes;
}

void expect_the_same_file(const std::string& arguments) {
  const OwnFolder cache("bits");
  const std::string one = archive_of(arguments, cache, 1);
  EXPECT_GT(one.size(), 10000u);
  for (const int threads : {2, 3}) EXPECT_TRUE(archive_of(arguments, cache, threads) == one) << threads << " threads";
}

class ArchiveBits : public ::testing::TestWithParam<Precomputed> {};

TEST_P(ArchiveBits, AreTheSameOnAnyNumberOfThreads) {
  expect_the_same_file(GetParam().arguments);
}

INSTANTIATE_TEST_SUITE_P(Bodies, ArchiveBits, ::testing::ValuesIn(kBodies),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(ArchiveBitsOfQuadraticElements, AreTheSameOnAnyNumberOfThreads) {
  const testing::LoopbackScene scene("archive-bits");
  expect_the_same_file(scene.scene());
}

}  // namespace
}  // namespace palpate

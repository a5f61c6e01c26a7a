#include "common/mesh/kept_reading.hpp"

#include <sys/wait.h>

#include <cstdlib>
#include <optional>

#include "common/mesh/child.hpp"
#include "common/mesh/generators.hpp"
#include "common/mesh/gmsh_library.hpp"
#include "common/mesh/mesh_file.hpp"
#include "tests/mesh/literal_files.hpp"
#include "tests/mesh/mesh_test_helpers.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

/// Puts an environment variable back when it goes.
class Variable {
 public:
  explicit Variable(const char* name) : name_(name) {
    if (const char* value = std::getenv(name)) before_ = value;
  }
  ~Variable() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TriangleMesh triangle(double height) {
  return {{{0, 0, height}, {1, 0, height}, {0, 1, height}}, {{0, 1, 2}}};
}

/// A cache folder, and surfaces of one triangle at two heights.
class KeptReading : public ::testing::Test {
 protected:
  KeptReading() {
    setenv("PALPATE_CACHE", cache().c_str(), 1);
    write_stl(triangle(1), a);
    write_stl(triangle(2), b);
  }
  fs::path cache() const { return folder.path("cache"); }
  fs::path place(const fs::path& file) const { return reading_place(file).value(); }
  static double height(const fs::path& file) { return load_triangle_mesh(file, 1).nodes.at(0).z(); }
  std::size_t files_kept() const {
    std::error_code none;
    const fs::directory_iterator files(readings_folder(cache()), none);
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
  }
  /// With it in place of what is kept of `a`, the library is asked, and its answer is kept again.
  void expect_made_anew(const std::string& spoiled, const std::string& what) const {
    const std::string good = bytes_of(place(a));
    ASSERT_NE(spoiled, good) << what;
    std::ofstream(place(a), std::ios::binary) << spoiled;
    EXPECT_EQ(kept_answer(place(a)), std::nullopt) << what;
    EXPECT_EQ(height(a), 1) << what;
    EXPECT_EQ(bytes_of(place(a)), good) << what;
  }

  Variable variable{"PALPATE_CACHE"};
  TestFolder folder;
  fs::path a = folder.path("a.stl"), b = folder.path("b.stl");
};

TEST_F(KeptReading, IsUsedInPlaceOfTheLibrary) {
  EXPECT_EQ(height(a), 1);
  EXPECT_EQ(height(b), 2);
  EXPECT_EQ(files_kept(), 2u) << "and no temporary file";
  keep_answer(place(a), kept_answer(place(b)).value());
  EXPECT_EQ(height(a), 2) << "what the library would not say";
  fs::copy_file(a, folder.path("copy.stl"));
  EXPECT_EQ(height(folder.path("copy.stl")), 2) << "bytes count, not names";
}

TEST_F(KeptReading, GivesTheMeshThatTheLibraryGives) {
  for (const auto& [name, bytes] : {std::pair{"a.msh", kGmsh2}, {"b.msh", kGmsh4}, {"c.vtk", kVtk}}) {
    const auto file = folder.write(name, bytes);
    const TetMesh first = load_tet_mesh(file, 1);
    ASSERT_TRUE(kept_answer(place(file))) << name;
    const TetMesh second = load_tet_mesh(file, 1);
    EXPECT_EQ(first.nodes, second.nodes) << name;
    EXPECT_EQ(first.tetrahedra, second.tetrahedra) << name;
    ASSERT_EQ(first.groups.size(), second.groups.size()) << name;
    for (const auto& [group, members] : first.groups) {
      EXPECT_EQ(members.nodes, second.groups.at(group).nodes) << name << ", " << group;
      EXPECT_EQ(members.tetrahedra, second.groups.at(group).tetrahedra) << name << ", " << group;
    }
  }
}

TEST_F(KeptReading, IsOfTheseBytesAndThisExtension) {
  EXPECT_EQ(height(a), 1);
  const fs::path before = place(a);
  write_stl(triangle(3), a);
  EXPECT_NE(place(a), before);
  EXPECT_EQ(height(a), 3);
  EXPECT_NE(place(folder.write("a.msh", kGmsh2)), place(folder.write("a.vtk", kGmsh2)));
}

TEST_F(KeptReading, ThatIsDamagedCutShortOrAnothersIsMadeAnew) {
  height(a), height(b);
  const std::string good = bytes_of(place(a));
  for (std::size_t at = 0; at < good.size(); at += 7) {
    std::string flipped = good;
    flipped[at] ^= 1;
    expect_made_anew(flipped, "flipped at " + std::to_string(at));
    expect_made_anew(good.substr(0, at), "cut at " + std::to_string(at));
  }
  expect_made_anew(good + '\0', "with a byte more");
  expect_made_anew(bytes_of(place(b)), "another file's");
  expect_made_anew("no answer at all, but long enough that all of its head could stand in it: is it read?", "text");
  expect_made_anew(replaced(good, "gmsh ", "gmsh 9"), "another version's");
}

TEST_F(KeptReading, ThatIsNoFileIsNoError) {
  fs::create_directories(place(a) / "x");
  EXPECT_EQ(height(a), 1);
  fs::create_symlink("/dev/zero", place(b));
  EXPECT_EQ(height(b), 2);
}

TEST_F(KeptReading, WhoseChecksumIsRightAndWhoseNumbersCannotBeIsMadeAnew) {
  height(a);
  const std::string good = kept_answer(place(a)).value();
  std::string huge = good;
  huge.replace(0, 8, std::string(8, '\xff'));
  // Two numbers for three nodes.
  const std::string other_nodes = raw<std::size_t>({2, 1, 2}) + good.substr(4 * sizeof(std::size_t));
  for (const std::string& answer :
       {std::string(), std::string("x"), good.substr(0, good.size() - 1), huge, other_nodes}) {
    keep_answer(place(a), answer);
    EXPECT_EQ(height(a), 1);
    EXPECT_EQ(kept_answer(place(a)), good);
  }
}

TEST_F(KeptReading, IsHeldAgainstTheFilesOwnList) {
  const auto one = folder.write("a.msh", kGmsh2), other = folder.write("b.msh", replaced(kGmsh2, "8 1 1 1", "8 1 1 2"));
  load_tet_mesh(one, 1), load_tet_mesh(other, 1);
  keep_answer(place(one), kept_answer(place(other)).value());
  EXPECT_EQ(sentence_of([&] { load_tet_mesh(one, 1); }),
            one.string() + ": its lists can be read in two ways, the file is damaged");
}

TEST_F(KeptReading, IsNoneOfARefusal) {
  const auto file = folder.write("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\nmany\n");
  const std::string refusal = sentence_of([&] { read_with_library(file); });
  EXPECT_TRUE(refusal.starts_with("the gmsh library refuses it: ")) << refusal;
  EXPECT_EQ(files_kept(), 0u);
  EXPECT_EQ(sentence_of([&] { read_with_library(file); }), refusal);
}

TEST_F(KeptReading, IsNoneWhereNothingCanBeWritten) {
  setenv("PALPATE_CACHE", a.c_str(), 1);
  EXPECT_EQ(height(b), 2);
  EXPECT_EQ(kept_answer(place(b)), std::nullopt);
}

TEST_F(KeptReading, IsNoneWithoutAUsersCache) {
  const Variable home("HOME"), caches("XDG_CACHE_HOME");
  for (const char* name : {"PALPATE_CACHE", "XDG_CACHE_HOME", "HOME"}) unsetenv(name);
  EXPECT_EQ(reading_place(a), std::nullopt);
  EXPECT_EQ(height(a), 1);
}

TEST_F(KeptReading, LiesInTheUsersCache) {
  const Variable home("HOME"), caches("XDG_CACHE_HOME");
  EXPECT_EQ(place(a).parent_path(), cache() / "readings");
  unsetenv("PALPATE_CACHE");
  setenv("XDG_CACHE_HOME", "/caches", 1);
  EXPECT_EQ(place(a).parent_path(), "/caches/palpate/readings");
  unsetenv("XDG_CACHE_HOME");
  setenv("HOME", "/home/somebody", 1);
  EXPECT_EQ(place(a).parent_path(), "/home/somebody/.cache/palpate/readings");
}

TEST_F(KeptReading, IsOfSixteenMegabytesAtMost) {
  keep_answer(place(a), std::string((16 << 20) + 1, 'x'));
  EXPECT_EQ(files_kept(), 0u);
  keep_answer(place(a), std::string(16 << 20, 'x'));
  EXPECT_EQ(files_kept(), 1u);
  EXPECT_TRUE(kept_answer(place(a)));
}

TEST_F(KeptReading, MayBeReadAndWrittenByProcessesAtOnce) {
  const auto reader = [&](int rounds) {
    for (int i = 0; i < rounds; ++i) {
      if (i % 3 == 0) fs::remove(place(a));
      if (height(a) != 1) return false;
    }
    return true;
  };
  std::vector<pid_t> readers;
  for (int i = 0; i < 4; ++i) {
    readers.push_back(fork());
    if (readers.back() == 0) _exit(reader(12) ? 0 : 1);
  }
  for (const pid_t reader : readers) {
    int status = -1;
    waitpid(reader, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(height(a), 1);
  EXPECT_EQ(files_kept(), 1u) << "and no temporary file";
}

}  // namespace
}  // namespace palpate

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <functional>
#include <limits>

#include "common/archive/hdf5_file.hpp"
#include "tests/tensors/files_for_tests.hpp"

namespace palpate {
namespace {

using testing::make_archive;
using testing::refusal;
using testing::TemporaryFolder;

bool says(const std::string& sentence, const std::string& part) {
  return sentence.find(part) != std::string::npos;
}

TEST(ArchiveFaults, TruncatedAtAnyLengthIsRefused) {
  const TemporaryFolder folder;
  write_archive(make_archive(20, 8), folder / "a.h5");
  const auto bytes = testing::read_bytes(folder / "a.h5");
  for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 7) {
    testing::write_bytes(folder / "b.h5", bytes, length);
    const auto sentence = refusal(folder / "b.h5", ArchivePart::header);
    EXPECT_TRUE(says(sentence, "truncated") || says(sentence, "not a palpate archive") || says(sentence, "damaged"))
        << length << ": " << sentence;
  }
  testing::write_bytes(folder / "b.h5", bytes, bytes.size() - 1);
  EXPECT_EQ(refusal(folder / "b.h5"), (folder / "b.h5").string() + ": truncated");
}

TEST(ArchiveFaults, FlippedByteIsRefusedOrChangesNothing) {
  const TemporaryFolder folder;
  const auto archive = make_archive(6, 3);
  write_archive(archive, folder / "a.h5");
  const auto bytes = testing::read_bytes(folder / "a.h5");
  std::fstream file(folder / "a.h5", std::ios::in | std::ios::out | std::ios::binary);
  const auto put = [&](std::size_t at, char byte) { file.seekp(static_cast<long>(at)).put(byte).flush(); };
  int refused = 0;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    put(i, static_cast<char>(bytes[i] ^ (1 << (i % 8))));
    try {
      const auto read = read_archive(folder / "a.h5", ArchivePart::surface, archive.content_hash);
      ASSERT_TRUE(testing::same(read, archive)) << "byte " << i;
    } catch (const std::runtime_error&) {
      ++refused;
    }
    put(i, bytes[i]);
  }
  EXPECT_GT(refused, static_cast<int>(bytes.size() / 3) / 2);
}

TEST(ArchiveFaults, FlippedPayloadIsNamed) {
  const TemporaryFolder folder;
  const auto archive = make_archive(20, 8);
  write_archive(archive, folder / "a.h5");
  auto bytes = testing::read_bytes(folder / "a.h5");
  const auto* values = reinterpret_cast<const char*>(archive.touchable_compliance.data());
  const auto place = std::search(bytes.begin(), bytes.end(), values, values + 64);
  ASSERT_NE(place, bytes.end());
  place[17] ^= 4;
  testing::write_bytes(folder / "a.h5", bytes, bytes.size());
  EXPECT_TRUE(says(refusal(folder / "a.h5"), "damaged: 'touchable/compliance' fails its checksum"));
}

TEST(ArchiveFaults, ForeignFilesAreRefused) {
  const TemporaryFolder folder;
  const std::string text = "node,x,y,z\n";
  testing::write_bytes(folder / "text.h5", {text.begin(), text.end()}, text.size());
  EXPECT_EQ(refusal(folder / "text.h5"), (folder / "text.h5").string() + ": not a palpate archive");
  Hdf5Writer other(folder / "other.h5");
  other.dataset({"x", "m", "something else"}, std::vector<double>{1, 2, 3});
  other.close();
  EXPECT_EQ(refusal(folder / "other.h5"), (folder / "other.h5").string() + ": not a palpate archive");
  EXPECT_EQ(refusal(folder / "none.h5"), (folder / "none.h5").string() + ": no such file");
  EXPECT_TRUE(says(refusal(folder.path()), "not a palpate archive"));
}

TEST(ArchiveFaults, OtherFormatVersionsAreRefused) {
  const TemporaryFolder folder;
  Hdf5Writer later(folder / "a.h5");
  later.attribute("format", "palpate compliance archive");
  later.attribute("format_version", std::int64_t{kArchiveFormat + 1});
  later.close();
  EXPECT_EQ(refusal(folder / "a.h5"), (folder / "a.h5").string() + ": format version 12, this program reads 11");
}

TEST(ArchiveFaults, PartsThatDoNotFitTogetherAreRefused) {
  const TemporaryFolder folder;
  const std::vector<std::function<void(Archive&)>> faults{
      [](Archive& a) { a.tetrahedra[2][1] = a.surface.size(); },
      [](Archive& a) { a.tetrahedra.clear(); },
      [](Archive& a) { a.tetrahedra.pop_back(); },  // materials are left over
      [](Archive& a) { a.density.pop_back(); },
      [](Archive& a) { a.parts.condensed = false; },
      [](Archive& a) {
        a.presses = {{{0, 0, 0}, 0.001, {}, {}}};
      },
      [](Archive& a) {
        a.presses = {{{0, 0, 0}, 0.001, {{2, 2}, {1, 3}}, {}}};
      },
      [](Archive& a) { a.condensed.reset(); },
      [](Archive& a) { a.condensed->connection[0] = -1; },
      [](Archive& a) { a.condensed->mass.pop_back(); },
      [](Archive& a) { a.condensed->dofs[0].node = 3; },  // no connection node
      [](Archive& a) { a.condensed->stiffness.pop_back(); },
      [](Archive& a) { a.condensed->reaction.pop_back(); },
      [](Archive& a) { a.condensed->follow.resize(a.condensed->follow.size() - a.condensed->dofs.size()); },
      [](Archive& a) { a.condensed->sag.pop_back(); },
      [](Archive& a) { a.condensed->interface[0][3] = 16; },
      [](Archive& a) { a.condensed->gap[1].triangle[2] = 99; },
      [](Archive& a) { a.condensed->quasi_static_triangles = 100; },
      [](Archive& a) { a.surface.triangles[3][1] = a.surface.size(); },
      [](Archive& a) { a.surface.triangles[3][1] = -1; },
      [](Archive& a) { a.surface.triangles[3][1] = a.surface.triangles[3][0]; },
      [](Archive& a) { a.surface.node_number[3] = a.mesh_nodes; },
      [](Archive& a) { a.surface.node_number[3] = a.surface.node_number[2]; },
      [](Archive& a) { a.surface.touchable = a.surface.size() + 1; },
      [](Archive& a) {
        a.touchable_dofs[3] = {1 << 30, 0};
      },
      [](Archive& a) { a.touchable_dofs[3].axis = 3; },
      [](Archive& a) { a.touchable_dofs[3] = a.touchable_dofs[2]; },
      [](Archive& a) {
        a.touchable_dofs[0] = {0, 0};
      },  // fixed
      [](Archive& a) { a.other_dofs[0].node = 0; },
      [](Archive& a) { a.touchable_compliance[2] = -1; },  // of the second dof with itself
      [](Archive& a) { a.touchable_compliance[1] = 1.5; },
  };
  write_archive(testing::make_hybrid_archive(20, 8), folder / "a.h5");
  EXPECT_EQ(refusal(folder / "a.h5"), "");
  for (std::size_t i = 0; i < faults.size(); ++i) {
    auto archive = testing::make_hybrid_archive(20, 8);
    faults[i](archive);
    write_archive(archive, folder / "a.h5");
    EXPECT_EQ(refusal(folder / "a.h5"), (folder / "a.h5").string() + ": damaged: its datasets do not fit together")
        << i;
  }
}

TEST(ArchiveFaults, NumbersThatCannotBeAreNamed) {
  const TemporaryFolder folder;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN(), kEndless = std::numeric_limits<double>::infinity();
  const auto expect_named = [&](const char* name, auto&& change) {
    auto archive = testing::make_hybrid_archive(20, 8);
    change(archive);
    write_archive(archive, folder / "a.h5");
    const std::string said = refusal(folder / "a.h5");
    EXPECT_TRUE(says(said, std::string("damaged: ") + name)) << name << ": " << said;
  };
  expect_named("'surface/position' has", [&](Archive& a) { a.surface.position[2].y() = kNone; });
  expect_named("'touchable/compliance' has", [&](Archive& a) { a.touchable_compliance[4] = kEndless; });
  expect_named("'material/young' has", [](Archive& a) { a.young[1] = 0; });
  expect_named("'material/poisson' has", [](Archive& a) { a.poisson[0] = 0.5; });
  expect_named("'material/of_element' names", [](Archive& a) { a.material_of_element[0] = 2; });
  expect_named("'hybrid/stiffness' has", [&](Archive& a) { a.condensed->stiffness[0] = kNone; });
  expect_named("'hybrid/mass' has", [](Archive& a) { a.condensed->mass[0] = -1; });
  expect_named("attribute 'hybrid_bound' is no number", [&](Archive& a) { a.condensed->bound = kNone; });
  expect_named("attribute 'mesh_nodes' is no count", [](Archive& a) { a.mesh_nodes = -1; });
}

TEST(ArchiveFaults, StaleArchiveIsRefused) {
  const TemporaryFolder folder;
  write_archive(make_archive(5, 2), folder / "a.h5");
  EXPECT_EQ(refusal(folder / "a.h5", ArchivePart::header, "another hash"),
            (folder / "a.h5").string() + ": made for another mesh, material or boundary conditions");
}

TEST(ArchiveFaults, FolderThatCannotBeMadeIsNamed) {
  EXPECT_THROW(write_archive(make_archive(5, 2), "/proc/none/a.h5"), std::runtime_error);
}

/// Runs `work` in a process of its own and returns its wait status.
int in_child(const std::function<int()>& work, const std::function<void(pid_t)>& meanwhile = {}) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  if (meanwhile) meanwhile(child);
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(ArchiveFaults, KilledWriterLeavesNoHalfFile) {
  const TemporaryFolder folder;
  const auto archive = make_archive(400, 0), small = make_archive(5, 2);
  std::mt19937 random(5);
  int abandoned = 0;
  for (int round = 0; round < 40; ++round) {
    in_child(
        [&] {
          for (;;) write_archive(archive, folder / "a.h5");
          return 0;
        },
        [&](pid_t child) {
          usleep(200 + random() % 20000);
          kill(child, SIGKILL);
        });
    for (const auto& name : folder.files()) abandoned += says(name, ".tmp-");
    if (std::filesystem::exists(folder / "a.h5")) {
      ASSERT_TRUE(testing::same(read_archive(folder / "a.h5", ArchivePart::surface, {}), archive));
    }
    write_archive(small, folder / "a.h5");  // the next writer cleans up
    for (const auto& name : folder.files()) ASSERT_FALSE(says(name, ".tmp-")) << name;
    std::filesystem::remove(folder / "a.h5");
  }
  EXPECT_GT(abandoned, 0) << "no kill came while a file was being written: the test shows nothing";
}

TEST(ArchiveFaults, TemporaryFileOfALivingWriterIsKept) {
  const TemporaryFolder folder;
  const auto mine = "a.h5.tmp-" + std::to_string(getppid()) + "-0123456789abcdef.h5";
  testing::write_bytes(folder / mine, {}, 0);
  write_archive(make_archive(5, 2), folder / "a.h5");
  EXPECT_TRUE(std::filesystem::exists(folder / mine));
}

TEST(ArchiveFaults, FileSizeLimitIsSaidAndNothingIsLeft) {
  const TemporaryFolder folder;
  const int status = in_child([&] {
    const rlimit limit{200 * 1024, 200 * 1024};
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      write_archive(make_archive(100, 0), folder / "a.h5");
    } catch (const std::exception& error) {
      return says(error.what(), "a.h5: cannot be written: File too large") ? 0 : 2;
    }
    return 1;
  });
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(folder.files().empty());
}

/// A file system of 256 kB.
class SmallDisk {
 public:
  SmallDisk() : mounted_(mount("tmpfs", folder_.path().c_str(), "tmpfs", 0, "size=256k") == 0) {}
  ~SmallDisk() {
    if (mounted_) umount(folder_.path().c_str());
  }
  bool mounted() const { return mounted_; }
  const TemporaryFolder& folder() const { return folder_; }

 private:
  TemporaryFolder folder_;
  bool mounted_;
};

TEST(ArchiveFaults, FullDiskIsSaidAndNothingIsLeft) {
  const SmallDisk disk;
  if (!disk.mounted()) GTEST_SKIP() << "mounting a small file system is not permitted here";
  try {
    write_archive(make_archive(100, 0), disk.folder() / "a.h5");
    FAIL() << "an archive of 350 kB fitted on 256 kB";
  } catch (const std::exception& error) {
    EXPECT_TRUE(says(error.what(), "a.h5: cannot be written: No space left on device")) << error.what();
  }
  EXPECT_TRUE(disk.folder().files().empty());
  write_archive(make_archive(5, 2), disk.folder() / "b.h5");  // what fits still goes
  EXPECT_EQ(refusal(disk.folder() / "b.h5"), "");
}

TEST(ArchiveFaults, DiskThatFillsDuringTheWriteIsSaid) {
  const SmallDisk disk;
  if (!disk.mounted()) GTEST_SKIP() << "mounting a small file system is not permitted here";
  try {
    Hdf5Writer writer(disk.folder() / "a.h5");
    writer.dataset({"x", "m", "too much"}, std::vector<double>(100000, 1.0));
    writer.close();
    FAIL() << "800 kB fitted on 256 kB";
  } catch (const std::exception& error) {
    EXPECT_TRUE(says(error.what(), "No space left on device")) << error.what();
  }
}

}  // namespace
}  // namespace palpate

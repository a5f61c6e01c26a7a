#include "common/archive/archive.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

#include "common/archive/archive_place.hpp"
#include "tests/tensors/files_for_tests.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using testing::make_archive;
using testing::make_hybrid_archive;
using testing::TemporaryFolder;

TEST(Archive, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  const auto archive = make_archive(20, 8);
  write_archive(archive, folder / "a.h5");
  EXPECT_TRUE(testing::same(read_archive(folder / "a.h5", ArchivePart::surface, archive.content_hash), archive));
  EXPECT_EQ(folder.files(), std::vector<std::string>{"a.h5"});
}

TEST(Archive, ReadsBackWithoutOtherNodesAndRegions) {
  const TemporaryFolder folder;
  auto archive = make_archive(20, 0);
  archive.material_of_element.clear();
  archive.young.resize(1);
  archive.poisson.resize(1);
  write_archive(archive, folder / "a.h5");
  EXPECT_TRUE(testing::same(read_archive(folder / "a.h5", ArchivePart::surface, {}), archive));
}

TEST(Archive, ReadsBackThePressesOfABody) {
  const TemporaryFolder folder;
  auto archive = make_archive(20, 8);
  archive.presses = {{{1, 2, 3}, 0.002, {{1, 1.5}, {2, 3.5}}, {{0.1, 0.2}}}, {{4, 5, 6}, 0.001, {{1, 1}}, {}}};
  write_archive(archive, folder / "a.h5");
  EXPECT_TRUE(testing::same(read_archive(folder / "a.h5", ArchivePart::surface, {}), archive));
  EXPECT_EQ(read_archive(folder / "a.h5", ArchivePart::header, {}).presses, archive.presses);
}

TEST(Archive, ReadsBackWhatMovesWithInertia) {
  const TemporaryFolder folder;
  auto archive = make_hybrid_archive(20, 8);
  write_archive(archive, folder / "a.h5");
  EXPECT_TRUE(testing::same(read_archive(folder / "a.h5", ArchivePart::surface, {}), archive));
  archive.model = "tensor_mass";
  archive.parts.condensed = false;
  archive.condensed.reset();
  archive.touchable_dofs.clear();
  archive.other_dofs.clear();
  archive.touchable_compliance.clear();
  archive.other_compliance.clear();
  write_archive(archive, folder / "b.h5");
  EXPECT_TRUE(testing::same(read_archive(folder / "b.h5", ArchivePart::surface, {}), archive));
}

TEST(Archive, HeaderHasTheTopologyOfAHybridBodyWithoutItsTensors) {
  const TemporaryFolder folder;
  const auto archive = make_hybrid_archive(20, 8);
  write_archive(archive, folder / "a.h5");
  const auto header = read_archive(folder / "a.h5", ArchivePart::header, {});
  EXPECT_EQ(header.tetrahedra, archive.tetrahedra);
  EXPECT_EQ(header.condensed->connection, archive.condensed->connection);
  EXPECT_EQ(header.condensed->interface, archive.condensed->interface);
  EXPECT_TRUE(header.condensed->stiffness.empty());
  EXPECT_TRUE(header.condensed->follow.empty());
}

TEST(Archive, ReplacesTheFileThatWasThere) {
  const TemporaryFolder folder;
  write_archive(make_archive(5, 2, 1), folder / "a.h5");
  const auto second = make_archive(9, 3, 2);
  write_archive(second, folder / "a.h5");
  EXPECT_TRUE(testing::same(read_archive(folder / "a.h5", ArchivePart::surface, {}), second));
}

TEST(Archive, MakesTheFolderItIsToLiveIn) {
  const TemporaryFolder folder;
  write_archive(make_archive(5, 2), folder / "deep/er/a.h5");
  EXPECT_EQ(testing::refusal(folder / "deep/er/a.h5"), "");
}

TEST(Archive, PartsLeaveOutTheRest) {
  const TemporaryFolder folder;
  const auto archive = make_archive(20, 8);
  write_archive(archive, folder / "a.h5");
  const auto header = read_archive(folder / "a.h5", ArchivePart::header, {});
  EXPECT_TRUE(header.touchable_compliance.empty());
  EXPECT_EQ(header.surface.position, archive.surface.position);
  const auto touchable = read_archive(folder / "a.h5", ArchivePart::touchable, {});
  EXPECT_EQ(touchable.touchable_compliance, archive.touchable_compliance);
  EXPECT_TRUE(touchable.other_compliance.empty());
}

TEST(Archive, TouchablePartDoesNotReadTheOtherRows) {
  const TemporaryFolder folder;
  const auto archive = make_archive(20, 8);
  write_archive(archive, folder / "a.h5");
  auto bytes = testing::read_bytes(folder / "a.h5");
  const auto* first = reinterpret_cast<const char*>(archive.other_compliance.data());
  const auto place = std::search(bytes.begin(), bytes.end(), first, first + 64);
  ASSERT_NE(place, bytes.end());
  std::fill(place, place + 64, '\0');
  testing::write_bytes(folder / "a.h5", bytes, bytes.size());
  EXPECT_EQ(testing::refusal(folder / "a.h5", ArchivePart::touchable), "");
  EXPECT_NE(testing::refusal(folder / "a.h5", ArchivePart::surface).find("'other/compliance' fails its checksum"),
            std::string::npos);
}

constexpr fs::perms kNoWriting =
    fs::perms::owner_read | fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec;

TEST(Archive, LivesBesideTheMeshOrInTheUsersCacheWhereNothingMayBeWrittenThere) {
  const TemporaryFolder folder;
  const auto mesh = folder / "liver.msh", beside = folder / ".palpate" / "liver-abc.h5";
  const auto place = [&] { return archive_path(mesh, "liver", "abc"); };
  unsetenv("PALPATE_CACHE");
  EXPECT_EQ(place(), beside);

  const uid_t user = geteuid(), other = user == 0 ? 65534 : user;  // permissions do not hold before root
  fs::permissions(folder / ".", kNoWriting);
  ASSERT_EQ(seteuid(other), 0);
  const std::string caches = std::getenv("XDG_CACHE_HOME") ? std::getenv("XDG_CACHE_HOME") : "";
  setenv("XDG_CACHE_HOME", "/caches", 1);
  EXPECT_EQ(place(), "/caches/palpate/liver-abc.h5");
  unsetenv("XDG_CACHE_HOME");
  const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
  setenv("HOME", "/home/somebody", 1);
  EXPECT_EQ(place(), "/home/somebody/.cache/palpate/liver-abc.h5");
  unsetenv("HOME");
  EXPECT_THROW(place(), std::runtime_error);
  setenv("PALPATE_CACHE", "/cache", 1);
  EXPECT_EQ(place(), "/cache/liver-abc.h5");
  unsetenv("PALPATE_CACHE");
  if (!home.empty()) setenv("HOME", home.c_str(), 1);
  if (!caches.empty()) setenv("XDG_CACHE_HOME", caches.c_str(), 1);
  ASSERT_EQ(seteuid(user), 0);

  // What came with the mesh is used, though nothing can be added.
  fs::permissions(folder / ".", kNoWriting | fs::perms::owner_write);
  fs::create_directory(folder / ".palpate");
  testing::write_bytes(beside, std::vector<char>{'a'}, 1);
  fs::permissions(folder / ".palpate", kNoWriting);
  ASSERT_EQ(seteuid(other), 0);
  EXPECT_EQ(place(), beside);
  ASSERT_EQ(seteuid(user), 0);
}

/// What a stranger to this program sees.
TEST(Archive, OpensInH5pyWithUnitsAndDescriptions) {
  if (std::system("/usr/bin/python3 -c 'import h5py' 2>/dev/null") != 0) GTEST_SKIP() << "there is no h5py here";
  const TemporaryFolder folder;
  const auto archive = make_archive(20, 8);
  write_archive(archive, folder / "a.h5");
  const std::string script =
      "/usr/bin/python3 -c \"import h5py, sys\n"
      "f = h5py.File(sys.argv[1], 'r')\n"
      "names = []\n"
      "f.visititems(lambda n, o: names.append(n) if isinstance(o, h5py.Dataset) else None)\n"
      "for n in names: assert f[n].attrs['units'] and f[n].attrs['description'], n\n"
      "assert f['touchable/compliance'].attrs['units'] in ('m/N', b'm/N')\n"
      "t = f['touchable/dofs'].shape[0]\n"
      "assert f['touchable/compliance'].shape == (t*(t+1)//2,)\n"
      "assert f['other/compliance'].shape == (f['other/dofs'].shape[0], t)\n"
      "assert f['surface/position'].shape == (28, 3) and f['surface/node_number'][3] == 6\n"
      "assert f.attrs['content_hash'] in ('0123456789abcdef0123456789abcdef', "
      "b'0123456789abcdef0123456789abcdef')\n"
      "assert f.attrs['format_version'] == 11 and f['material/young'][1] == 2e4\n\" ";
  EXPECT_EQ(std::system((script + (folder / "a.h5").string()).c_str()), 0);
}

}  // namespace
}  // namespace palpate

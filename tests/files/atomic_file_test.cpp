#include "common/files/atomic_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>

namespace palpate {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// The number of a process that has ended.
pid_t ended_process() {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  return child;
}

class AtomicFileTest : public ::testing::Test {
 protected:
  AtomicFileTest() : folder_(fs::temp_directory_path() / fmt::format("palpate-atomic-{}", getpid())) {
    fs::create_directories(folder_);
  }
  ~AtomicFileTest() override { fs::remove_all(folder_); }
  fs::path file(const std::string& name) const { return folder_ / name; }
  fs::path left_by(pid_t process, const std::string& target) const {
    return file(fmt::format("{}.tmp-{}-{:016x}{}", target, process, 7, fs::path(target).extension().string()));
  }
  fs::path folder_;
};

class AtomicFileKinds : public AtomicFileTest, public ::testing::WithParamInterface<AtomicFile::Temporary> {};
INSTANTIATE_TEST_SUITE_P(Both, AtomicFileKinds,
                         ::testing::Values(AtomicFile::Temporary::unnamed, AtomicFile::Temporary::named));

TEST_P(AtomicFileKinds, AppearsWholeAndLeavesNothingWithoutACommit) {
  write(file("a.csv"), "before");
  {
    const AtomicFile whole(file("a.csv"), 0, GetParam());
    write(whole.handle(), "half");
    EXPECT_EQ(text_of(file("a.csv")), "before");
  }
  EXPECT_EQ(text_of(file("a.csv")), "before");
  AtomicFile whole(file("a.csv"), 0, GetParam());
  write(whole.handle(), "all");
  whole.commit();
  EXPECT_EQ(text_of(file("a.csv")), "all");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_P(AtomicFileKinds, AFileThatIsOpenGoesOnAfterItsNameIsGiven) {
  AtomicFile whole(file("a.csv"), 0, GetParam());
  std::ofstream out(whole.handle());
  out << "first" << std::flush;
  whole.commit();
  out << ", second" << std::flush;
  EXPECT_EQ(text_of(file("a.csv")), "first, second");
}

TEST_F(AtomicFileTest, OfAKilledWriterNothingIsLeft) {
  const pid_t writer = fork();
  if (writer == 0) {
    const AtomicFile whole(file("a.csv"));
    write(whole.handle(), "half");
    raise(SIGKILL);
  }
  waitpid(writer, nullptr, 0);
  for (const auto& left : fs::directory_iterator(folder_)) ADD_FAILURE() << left.path();
}

TEST_F(AtomicFileTest, ANamedOneEndsAsItsTargetAndIsWrittenByItsHandleWhateverHasTakenItsName) {
  write(file("victim"), "precious");
  const AtomicFile whole(file("a.csv"), 0, AtomicFile::Temporary::named);
  EXPECT_EQ(whole.path().extension(), ".csv");
  fs::remove(whole.path());
  fs::create_symlink("victim", whole.path());
  write(whole.handle(), "ours");
  EXPECT_EQ(text_of(file("victim")), "precious");
}

TEST_F(AtomicFileTest, RemovesWhatKilledWritersLeftOfItsTargetAndNothingElse) {
  const pid_t gone = ended_process();
  const fs::path own = left_by(gone, "a.h5"), others = left_by(gone, "b.h5"), living = left_by(getppid(), "a.h5");
  const fs::path named_alike = file(fmt::format("a.h5.tmp-{}-notes", gone));
  for (const fs::path& left : {own, others, living, named_alike}) write(left, "x");
  const AtomicFile whole(file("a.h5"));
  EXPECT_FALSE(fs::exists(own));
  for (const fs::path& kept : {others, living, named_alike}) EXPECT_TRUE(fs::exists(kept)) << kept;
}

TEST_F(AtomicFileTest, AFolderThatIsNotThereIsSaidAndMadeOnlyOnDemand) {
  EXPECT_THROW(AtomicFile(file("none/a.h5")), std::runtime_error);
  make_folder_of(file("none/a.h5"));
  EXPECT_NO_THROW(AtomicFile(file("none/a.h5")));
}

}  // namespace
}  // namespace palpate

// A log is verified where nothing of its scene is.
#include <gtest/gtest.h>

#include <algorithm>

#include "common/bus/log_reader.hpp"
#include "common/bus/log_writer.hpp"
#include "common/describe/digest.hpp"
#include "idl/topics.hpp"
#include "tests/bus/domain.hpp"
#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using testing::LoopbackScene;
using testing::OwnFolder;
using testing::program;
using testing::run_program;

/// Writes a log anew with its files changed.
template <class Change>
void rewrite_files(const fs::path& from, const fs::path& to, Change&& change) {
  LogReader reader(from);
  LogWriter writer(to, reader.header());
  LogEvent event;
  for (bool first = true; reader.next(event); first = false) {
    writer.write_payload(event.channel, event.receive_ns, event.payload);
    if (!first) continue;
    LogReader files(from);
    for (LogFile file; files.next_file(file);) {
      change(file);
      writer.write(kFileChannel, event.receive_ns, file);
    }
  }
  writer.finish();
}

class ToolsTravel : public ::testing::Test {
 protected:
  /// Recorded from the nodes; then the scene, its mesh and its archive are gone.
  static void SetUpTestSuite() {
    away_ = std::make_unique<OwnFolder>("away");
    const LoopbackScene scene("travel", testing::kLinear);
    mesh_hash_ = file_digest(scene.folder() / "block.msh");
    const auto run = run_program(fmt::format("{} run {} --seconds 1.3 --domain {} --record {}", program("palpate"),
                                             scene.scene(), testing::own_domain(), log().string()));
    ASSERT_EQ(run.status, 0) << run.err;
    fs::copy_file(scene.folder() / "block.msh", *away_ / "a_mesh");
  }
  static void TearDownTestSuite() { away_.reset(); }

  static fs::path log() { return *away_ / "session.lcmlog"; }
  static fs::path changed() { return *away_ / "changed.lcmlog"; }
  static std::string verify(const fs::path& file, const std::string& more = "") {
    return program("palpate") + " replay --verify " + file.string() + " " + more;
  }

  static std::unique_ptr<OwnFolder> away_;
  static std::string mesh_hash_;
};
std::unique_ptr<OwnFolder> ToolsTravel::away_;
std::string ToolsTravel::mesh_hash_;

TEST_F(ToolsTravel, ALogVerifiesWithoutItsSceneAndLeavesNothing) {
  const OwnFolder temporary("travel-tmp");
  const auto verified = run_program(verify(log()).insert(0, "TMPDIR=" + temporary.path().string() + " "));
  EXPECT_EQ(verified.status, 0) << verified.err;
  EXPECT_NE(verified.out.find("equal bit for bit"), std::string::npos) << verified.out;
  EXPECT_TRUE(fs::is_empty(temporary.path()));

  const auto info = run_program(program("palpate") + " info " + log().string());
  EXPECT_NE(info.out.find(fmt::format("block.msh (0.0")), std::string::npos) << info.out;
  EXPECT_NE(info.out.find(mesh_hash_), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("motion.csv"), std::string::npos) << info.out;
  EXPECT_EQ(info.out.find("unknown topics"), std::string::npos) << info.out;
}

TEST_F(ToolsTravel, ALogVerifiesWhereLinearAlgebraHasMoreThreads) {
  const auto verified = run_program("OPENBLAS_NUM_THREADS=2 " + verify(log()));
  EXPECT_EQ(verified.status, 0) << verified.err;
}

TEST_F(ToolsTravel, TensorsThatWereComputedOnThisHostAreToldOf) {
  const auto verified = run_program(verify(log()));
  EXPECT_NE(verified.out.find("tensors of \'block\' that were computed on this host"), std::string::npos)
      << verified.out;
}

TEST_F(ToolsTravel, WhereForcesDifferTheKernelsThatTheTensorsAreByAreTold) {
  fs::create_directory(*away_ / "kept");
  // Kernels for a processor of 2004 sum in another order.
  for (const std::string where : {"computed on this host by", "computed by"}) {  // the first leaves its archive there
    const auto elsewhere =
        run_program(fmt::format("OPENBLAS_CORETYPE=Prescott {} --data {}", verify(log()), (*away_ / "kept").string()));
    EXPECT_EQ(elsewhere.status, 1);
    EXPECT_NE(elsewhere.err.find("the forces differ"), std::string::npos) << elsewhere.err;
    EXPECT_NE(elsewhere.err.find(fmt::format("of 'block' were {} palpate", where)), std::string::npos) << elsewhere.err;
    EXPECT_NE(elsewhere.err.find("OpenBLAS for Prescott"), std::string::npos) << elsewhere.err;
  }
}

TEST_F(ToolsTravel, AMissingPieceIsToldWithItsHashAndFoundByItsContents) {
  rewrite_files(log(), changed(), [](LogFile& file) {
    if (file.path.ends_with("block.msh")) file.content.clear();
  });
  testing::expect_refusal(verify(changed()), {"block.msh", mesh_hash_, "--data"});
  const OwnFolder data("travel-data");
  testing::expect_refusal(verify(changed(), "--data " + data.path().string()), {"block.msh", mesh_hash_});
  fs::copy_file(*away_ / "a_mesh", data / "by_another_name.msh");
  const auto verified = run_program(verify(changed(), "--data " + data.path().string()));
  EXPECT_EQ(verified.status, 0) << verified.err;
  testing::expect_refusal(verify(changed(), "--data " + (data / "nowhere").string()), {"is no folder"});
}

TEST_F(ToolsTravel, AFileThatIsNotWhatItsHashSaysIsRefused) {
  rewrite_files(log(), changed(), [](LogFile& file) {
    if (file.path.ends_with("block.msh")) file.content[file.content.size() / 2] ^= 1;
  });
  testing::expect_refusal(verify(changed()), {"block.msh", "is not what its hash"});
  rewrite_files(log(), changed(), [](LogFile& file) { file.hash = "../../../escape"; });
  testing::expect_refusal(verify(changed()), {"is not what its hash"});
}

TEST_F(ToolsTravel, FilesThatTheHapticNodeDidNotHaveAreRefused) {
  rewrite_files(log(), changed(), [](LogFile& file) {
    if (!file.path.ends_with("block.msh")) return;
    file.content.push_back('\n');
    file.size = file.content.size();
    file.hash = digest(file.content.data(), file.content.size());
  });
  testing::expect_refusal(verify(changed()), {"the haptic node had other meshes"});
}

}  // namespace
}  // namespace palpate

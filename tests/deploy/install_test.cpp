#include <gtest/gtest.h>

#include <set>

#include "tests/bus/domain.hpp"
#include "tests/loopback/loopback_scene.hpp"

namespace palpate::testing {
namespace {

namespace fs = std::filesystem;

/// What `cmake --install` makes, moved to another place thereafter. Removed with the object.
class MovedPrefix {
 public:
  explicit MovedPrefix(const std::string& options)
      : folder_(fs::temp_directory_path() / fmt::format("palpate-install-{}", getpid())) {
    std::string said;
    const fs::path first = folder_.string() + "-first";
    if (run_command(
            fmt::format("{} --install {} --prefix {} {}", PALPATE_CMAKE, PALPATE_BUILD, first.string(), options),
            &said) != 0)
      throw std::runtime_error(said);
    fs::rename(first, folder_);
  }
  ~MovedPrefix() { fs::remove_all(folder_); }

  fs::path operator/(const std::string& part) const { return folder_ / part; }
  /// All files, relative to the prefix.
  std::set<std::string> files() const {
    std::set<std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      if (!entry.is_directory()) all.insert(fs::relative(entry.path(), folder_));
    return all;
  }

 private:
  fs::path folder_;
};

TEST(Install, AMovedPrefixRunsItsScenes) {
  const MovedPrefix prefix("");
  const std::string palpate = prefix / "bin/palpate", scenes = prefix / "share/palpate/scenes/";
  const std::string scene = scenes + "cylinder_tear.toml";  // whose archive takes the least time
  std::string said;
  EXPECT_EQ(run_command(palpate + " check " + scenes + "liver.toml", &said), 0) << said;
  EXPECT_EQ(run_command(fmt::format("{} run {} --seconds 1 --domain {}", palpate, scene, own_domain()), &said), 0)
      << said;
  EXPECT_NE(said.find("haptic "), std::string::npos) << said;
  EXPECT_EQ(run_command((prefix / "share/palpate/scripts/deploy.sh").string() + " --help", &said), 0) << said;
  const auto files = prefix.files();
  for (const char* name : {"bin/palpate_study", "share/palpate/docs/deploy.md", "share/palpate/idl/palpate.idl",
                           "share/palpate/scripts/deploy_remote.sh", "share/palpate/scripts/study_page.py",
                           "share/palpate/scripts/latency_plot.py", "share/palpate/systemd/palpate@.service"})
    EXPECT_TRUE(files.contains(name)) << name;
}

TEST(Install, TheOrganProgramIsAComponentOfItsOwn) {
  if (!fs::exists(fs::path(PALPATE_BIN) / "palpate_organ")) GTEST_SKIP() << "built without CGAL";
  const std::set<std::string> files{"bin/palpate_organ"};
  EXPECT_EQ(MovedPrefix("--component organ").files(), files);
}

TEST(Install, WithoutTheOrganProgramItsCommandsSayWhatIsMissing) {
  const MovedPrefix prefix("--component tools");
  std::string said;
  EXPECT_EQ(run_command((prefix / "bin/palpate").string() + " mesh a.stl -o a.msh", &said), 1);
  EXPECT_NE(said.find("libcgal-dev"), std::string::npos) << said;
}

TEST(Install, AComponentIsOneNode) {
  for (const std::string name : {"haptic", "deform", "render", "web"}) {
    const std::set<std::string> files{"bin/" + name + "_node"};
    EXPECT_EQ(MovedPrefix("--component " + name).files(), files);
  }
  EXPECT_EQ(MovedPrefix("--component ros").files(), std::set<std::string>{"bin/ros_bridge"});
  EXPECT_EQ(MovedPrefix("--component mesh").files(), std::set<std::string>{"lib/palpate/libpalpate_gmsh.so"});
}

}  // namespace
}  // namespace palpate::testing

// The examples of drivers, built outside the tree against an installed palpate, on a real haptic node.
#include <csignal>

#include "tests/drivers/driver_rig.hpp"
#include "tests/sanitized.hpp"

namespace palpate::testing {
namespace {

namespace fs = std::filesystem;

/// What drivers are built with, installed. Removed with the object.
class DevelopmentPrefix {
 public:
  DevelopmentPrefix() {
    must(fmt::format("{} --install {} --prefix {} --component dev", PALPATE_CMAKE, PALPATE_BUILD, folder_.string()));
  }
  ~DevelopmentPrefix() { fs::remove_all(folder_); }

  /// Builds the example of that name from its installed sources, with a sanitizer where the library is; its program.
  std::string build(const std::string& name) const {
    const fs::path made = folder_ / ("build-" + name);
    must(fmt::format("{} -S {} -B {} -DCMAKE_PREFIX_PATH={} '-DCMAKE_CXX_FLAGS={}' '-DCMAKE_C_FLAGS={}'", PALPATE_CMAKE,
                     (folder_ / "share/palpate/drivers" / name).string(), made.string(), folder_.string(),
                     PALPATE_CXX_FLAGS, PALPATE_C_FLAGS));
    must(fmt::format("{} --build {}", PALPATE_CMAKE, made.string()));
    return made / "press";
  }

 private:
  static void must(const std::string& command) {
    std::string said;
    if (run_command(command, &said) != 0) throw std::runtime_error(said);
  }
  fs::path folder_ = fs::temp_directory_path() / fmt::format("palpate-dev-{}", getpid());
};

const std::vector<std::string> kPress{"0", "0.18", "0.199"};

std::vector<std::string> with(std::vector<std::string> command, std::vector<std::string> before = {}) {
  command.insert(command.end(), before.begin(), before.end());
  command.insert(command.end(), kPress.begin(), kPress.end());
  return command;
}

TEST(Drivers, InCWithTheMiddlewareAndTheInstalledMessagesAlone) {
  const DevelopmentPrefix prefix;
  const std::string press = prefix.build("c");
  DriverRig rig;
  const std::string network =
      fmt::format("{} network {} --domain {} 2>/dev/null", program("palpate"), rig.scene(), own_domain());
  expect_a_whole_driver(rig, with({"/bin/sh", "-c", "CYCLONEDDS_URI=\"$(" + network + ")\" exec \"$@\"", "sh", press}));
}

TEST(Drivers, InCppWithTheInstalledLibrary) {
  const DevelopmentPrefix prefix;
  const std::string press = prefix.build("cpp");
  DriverRig rig;
  expect_a_whole_driver(rig, with({press}, {std::to_string(own_domain())}));
}

TEST(Drivers, InPythonWithItsModule) {
  const fs::path module = fs::path(PALPATE_BUILD) / "python";
  if (!fs::exists(module)) GTEST_SKIP() << "built without pybind11";
  if (kSanitized) GTEST_SKIP() << "Python itself has no sanitizer, which the module needs";
  DriverRig rig;
  expect_a_whole_driver(rig, with({"/usr/bin/env", "PYTHONPATH=" + module.string(), PALPATE_PYTHON3,
                                   PALPATE_SOURCE "/drivers/python/press.py"},
                                  {std::to_string(own_domain())}));
}

TEST(Drivers, TheNetworkThatIsPrintedIsTheScenes) {
  const LoopbackScene scene("network", kLinear);
  std::string said;
  EXPECT_EQ(run_command(fmt::format("(exec 2>/dev/null; {} network {} --domain 7)", program("palpate"), scene.scene()),
                        &said),
            0);
  EXPECT_EQ(said, dds_configuration({.domain = 7}) + "\n");
  EXPECT_NE(said.find("<Domain Id=\"7\">"), std::string::npos) << "who names no domain gets the scene's";
  EXPECT_EQ(run_command(fmt::format("{} network {} --interface nowhere0", program("palpate"), scene.scene()), &said),
            1);
  EXPECT_NE(said.find("no interface 'nowhere0'"), std::string::npos) << said;
}

}  // namespace
}  // namespace palpate::testing

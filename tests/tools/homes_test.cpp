#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using testing::program;
using testing::run_program;
using testing::text_of;

struct Include {
  std::string file;  ///< from the root
  std::string header;
};

/// Every #include of the programs' sources; tests and benchmarks may look at a package from outside.
std::vector<Include> all_includes() {
  const fs::path root = PALPATE_SOURCE;
  const std::regex line(R"(#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> found;
  for (const char* room : {"common", "haptic_node", "deform_node", "render_node", "web_node", "ros_bridge", "drivers",
                           "tools", "idl", "python"})
    for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
      const std::string kind = entry.path().extension();
      if (kind != ".cpp" && kind != ".hpp" && kind != ".h" && kind != ".c") continue;
      const std::string text = text_of(entry.path());
      for (std::sregex_iterator at(text.begin(), text.end(), line), end; at != end; ++at)
        found.push_back({fs::relative(entry.path(), root), (*at)[1]});
    }
  return found;
}

TEST(ToolsHomes, EveryPackageIsIncludedInItsHomeAlone) {
  const std::map<std::string, std::set<std::string>> homes{
      {R"((.*/)?gmshc?\.h(_cwrap)?)", {"common/mesh"}},
      {R"((.*/)?cholmod.*\.h)", {"common/fem"}},
      {R"((.*/)?(cblas|lapacke?|openblas.*)\.h)", {"common/fem"}},
      {R"(CLI/.*)", {"common/cli"}},
      {R"(spdlog/.*)", {"common/log"}},
      {R"(Spectra/.*)", {"common/shell"}},
      {R"((.*/)?(hdf5|H5.*)\.h)", {"common/archive"}},
      {R"((.*/)?toml(\+\+)?/.*|toml\.hpp)", {"common/scene"}},
      {R"(dds/.*)", {"common/bus", "idl", "drivers/c"}},
      {R"(lcm/.*)", {"common/bus"}},
      {R"(openssl/.*)", {"tools/keys"}},
      {R"(GL/.*)", {"render_node"}},
      {R"((.*/)?png\.h)", {"render_node"}},
      {R"(boost/.*)", {"web_node"}},
      {R"((.*/)?ft2build\.h)", {"render_node"}},
      {R"(spnav\.h)", {"drivers/spacemouse"}},
      {R"(CGAL/.*)", {"tools/organ"}},
      {R"(itk[A-Z].*\.h)", {"tools/organ"}},
      {R"(pybind11/.*)", {"python"}},
  };
  const std::vector<Include> includes = all_includes();
  for (const auto& [pattern, folders] : homes) {
    const std::regex header(pattern);
    int at_home = 0;
    for (const Include& i : includes) {
      if (!std::regex_match(i.header, header)) continue;
      const bool home = folders.contains(fs::path(i.file).parent_path());
      EXPECT_TRUE(home) << i.file << " includes " << i.header;
      at_home += home;
    }
    EXPECT_GT(at_home, 0) << pattern << " is included nowhere";
  }
}

std::string libraries_of(const std::string& name) {
  const auto result = run_program("ldd " + program(name));
  EXPECT_EQ(result.status, 0) << result.err;
  return result.out;
}

TEST(ToolsHomes, TheHapticNodeLinksNoPictureMeshFilmOrSolverLibrary) {
  const std::regex heavy(
      R"(lib(OSMesa|GL|gl2ps|png|freetype|gmsh|avcodec|avformat|avutil|swscale|cholmod|umfpack|openblas|lapack|blas)[.-])");
  std::smatch found;
  const std::string haptic = libraries_of("haptic_node");
  EXPECT_FALSE(std::regex_search(haptic, found, heavy)) << found.str();
  EXPECT_NE(haptic.find("libddsc"), std::string::npos);
  EXPECT_TRUE(std::regex_search(libraries_of("render_node"), heavy));
  EXPECT_TRUE(std::regex_search(libraries_of("palpate"), heavy));
}

TEST(ToolsHomes, OpenBlasIsTheProcessorsOwnUnlessTheEnvironmentSaysOtherwise) {
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) GTEST_SKIP() << "this processor has no AVX2";
  const auto core = [](const std::string& environment) {
    const auto said =
        run_program("env " + environment + " OPENBLAS_VERBOSE=2 " + program("palpate") + " --version").err;
    const std::size_t last = said.rfind("Core: ");
    return last == std::string::npos ? std::string() : said.substr(last + 6, said.find('\n', last) - last - 6);
  };
  EXPECT_NE(core("-u OPENBLAS_CORETYPE"), "Prescott");
  EXPECT_EQ(core("OPENBLAS_CORETYPE=Prescott"), "Prescott");
}

TEST(ToolsHomes, TheDeformationNodeStartsAnewWithOneThreadOfOpenBlasUnlessTheEnvironmentSaysOtherwise) {
  const auto starts = [](const std::string& environment) {
    const std::string said =
        run_program("env " + environment + " LD_DEBUG=libs " + program("deform_node") + " --version").err;
    const std::regex start("initialize program: \\S*deform_node");
    return std::distance(std::sregex_iterator(said.begin(), said.end(), start), std::sregex_iterator());
  };
  EXPECT_EQ(starts("-u OPENBLAS_NUM_THREADS"), 2);
  EXPECT_EQ(starts("OPENBLAS_NUM_THREADS=3"), 1);
}

TEST(ToolsHomes, GmshIsLoadedOnlyWhereAMeshIsReadForTheFirstTime) {
  const OwnFolder cache("readings");
  const auto loads_gmsh = [&](const std::string& arguments) {
    const auto result = run_program(
        fmt::format("LD_DEBUG=files PALPATE_CACHE={} {} {}", cache.path().string(), program("palpate"), arguments));
    EXPECT_EQ(result.status, 0) << arguments;
    return result.err.find("libgmsh") != std::string::npos;
  };
  EXPECT_FALSE(loads_gmsh("--help"));
  EXPECT_TRUE(loads_gmsh("check " PALPATE_SOURCE "/scenes/plate.toml"));
  EXPECT_FALSE(loads_gmsh("check " PALPATE_SOURCE "/scenes/plate.toml"));
}

}  // namespace
}  // namespace palpate

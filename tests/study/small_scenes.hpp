#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "common/mesh/generators.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/scene/scene.hpp"
#include "tools/study/one_mesh.hpp"
#include "tools/study/result.hpp"
#include "tools/study/study.hpp"

/// Scenes of small bodies, and what their studies gave.
namespace palpate::study::testing {

/// A folder of its own that is gone with the test.
struct Folder {
  Folder()
      : at(std::filesystem::path(::testing::TempDir()) /
           ("study_" + std::to_string(getpid()) + "_" +
            ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::remove_all(at);
    std::filesystem::create_directories(at);
  }
  ~Folder() { std::filesystem::remove_all(at); }
  std::filesystem::path at;
};

inline Scene write_scene(const std::filesystem::path& folder, const std::string& body, const std::string& tool) {
  const std::filesystem::path file = folder / "small.toml";
  std::ofstream(file) << body << tool;
  return load_scene(file);
}

inline const char* const kProbe = R"(
[[tool]]
name = "probe"
pivot = [0, 0, 0.3]
axis = [0, 0, -1]
up = [0, 1, 0]
radius = 0.012
trajectory = "still.csv"
[contact]
friction = 0.2
)";

inline void write_trajectory(const std::filesystem::path& folder) {
  std::ofstream(folder / "still.csv") << "time,yaw,pitch,depth,roll,grip\n0,0,0,0.1,0,0\n1,0,0,0.1,0,0\n";
}

/// 60 x 60 x 30 mm in cells of 10 mm, on its bottom.
inline Scene block_scene(const std::filesystem::path& folder, const std::string& more = "") {
  write_tet_mesh(make_block({-0.03, -0.03, 0}, {0.03, 0.03, 0.03}, {6, 6, 3}), folder / "block.msh");
  write_trajectory(folder);
  return write_scene(folder,
                     "[[body]]\nname = \"block\"\nmesh = \"block.msh\"\nyoung = 4000\npoisson = 0.4\ndensity = 1000\n" +
                         more + "[[body.fixed]]\ngroup = \"bottom\"\n",
                     kProbe);
}

inline OneMesh on_one(const Scene& scene) {
  return *on_one_mesh(scene.bodies[0]);
}

/// A catheter of 100 mm along x.
inline Scene catheter_scene(const std::filesystem::path& folder, int particles) {
  write_trajectory(folder);
  return write_scene(folder,
                     "[[body]]\nname = \"catheter\"\nmodel = \"catheter\"\nyoung = 5e6\ndensity = 1100\n"
                     "[body.catheter]\ntail = [0, 0, 0]\ntip = [0.1, 0, 0]\nparticles = " +
                         std::to_string(particles) + "\n",
                     kProbe);
}

/// References that the tests of a process keep for one another: a body is solved once.
inline const std::filesystem::path& kept_references() {
  static const struct Kept {
    ~Kept() { std::filesystem::remove_all(at); }
    std::filesystem::path at =
        std::filesystem::path(::testing::TempDir()) / ("study_references_" + std::to_string(getpid()));
  } kept;
  return kept.at;
}

inline StudyOptions quick() {
  return {.quick = true, .references = kept_references()};
}

inline const Row* find(const Result& result, const std::string& method, const std::string& knob,
                       const std::string& value, const std::string& reference) {
  for (const Row& r : result.rows)
    if (r.method == method && r.knob == knob && (value.empty() || r.value == value) && r.reference == reference)
      return &r;
  return nullptr;
}

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace palpate::study::testing

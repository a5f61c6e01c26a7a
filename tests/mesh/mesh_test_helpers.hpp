#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "common/mesh/quality.hpp"
#include "common/mesh/surface.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// A folder for one test, removed at its end.
class TestFolder {
 public:
  TestFolder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("palpate_") + test->name() + "_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~TestFolder() { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

 private:
  std::filesystem::path folder_;
};

inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The message of the std::runtime_error that `work` throws; empty where it throws none.
inline std::string sentence_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

inline double volume_of(const TetMesh& mesh) {
  double volume = 0;
  for (const auto& t : mesh.tetrahedra) volume += tet_volume(mesh, t);
  return volume;
}

/// Volume inside a surface by the divergence theorem; negative where it points inward.
template <class Triangles>
double enclosed_volume(const std::vector<Eigen::Vector3d>& nodes, const Triangles& triangles) {
  double volume = 0;
  for (const auto& [a, b, c] : triangles) volume += nodes[a].dot(nodes[b].cross(nodes[c])) / 6;
  return volume;
}

}  // namespace palpate

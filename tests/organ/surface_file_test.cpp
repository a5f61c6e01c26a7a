#include "tools/organ/surface_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "common/mesh/mesh_file.hpp"
#include "tests/organ/surfaces_for_tests.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/organ/surface_shells.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

class SurfaceFile : public ::testing::Test {
 protected:
  static std::string refusal(const std::filesystem::path& file) {
    try {
      read_surface(file, 1);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "read";
  }
  void expect_ball(const std::filesystem::path& file, double scale) const {
    const ReadSurface read = read_surface(file, scale);
    EXPECT_EQ(read.mesh.triangles.size(), ball_.triangles.size()) << file;
    EXPECT_NEAR(enclosed_volume(read.mesh), std::pow(scale, 3) * enclosed_volume(ball_), 1e-4 * std::pow(scale, 3))
        << file;
  }

  const OwnFolder folder_{"organ"};
  const TriangleMesh ball_ = make_sphere({1, 2, 3}, 1, 8);
  const std::uint32_t count_ = static_cast<std::uint32_t>(ball_.triangles.size());
};

TEST_F(SurfaceFile, EveryFormatGivesTheSameSurface) {
  std::string obj = "# comment\n", off = "OFF\n", ply = "ply\nformat ascii 1.0\n", vtp, points, corners, ends;
  ply += "element vertex " + std::to_string(ball_.nodes.size()) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(count_) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
  off += std::to_string(ball_.nodes.size()) + " " + std::to_string(count_) + " 0\n";
  for (const Eigen::Vector3d& x : ball_.nodes) {
    const std::string place = std::to_string(x.x()) + " " + std::to_string(x.y()) + " " + std::to_string(x.z()) + "\n";
    obj += "v " + place, off += place, ply += place, points += place;
  }
  for (const auto& [a, b, c] : ball_.triangles) {
    const auto numbers = [&, a = a, b = b, c = c](int from) {
      return std::to_string(a + from) + " " + std::to_string(b + from) + " " + std::to_string(c + from) + "\n";
    };
    obj += "f " + numbers(1), off += "3 " + numbers(0), ply += "3 " + numbers(0), corners += numbers(0);
    ends += std::to_string(3 * (ends.empty() ? 1 : std::count(ends.begin(), ends.end(), ' ') + 1)) + " ";
  }
  vtp = R"(<?xml version="1.0"?><VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<PolyData><Piece NumberOfPoints="1" NumberOfPolys="1"><Points>
<DataArray type="Float32" Name="Points" NumberOfComponents="3" format="ascii">)" +
        points + R"(</DataArray></Points><Polys><DataArray type="Int64" Name="connectivity" format="ascii">)" +
        corners + R"(</DataArray><DataArray type="Int64" Name="offsets" format="ascii">)" + ends +
        "</DataArray></Polys></Piece></PolyData></VTKFile>";
  expect_ball(write_file(folder_ / "ball.obj", obj), 1);
  expect_ball(write_file(folder_ / "ball.off", off), 1e-3);
  expect_ball(write_file(folder_ / "ball.ply", ply), 1);
  expect_ball(write_file(folder_ / "ball.vtp", vtp), 1);
  expect_ball(write_file(folder_ / "text.STL", text_stl(ball_)), 1e-3);
  expect_ball(write_file(folder_ / "binary.stl", binary_stl(ball_, "made by hand", count_)), 1);
}

TEST_F(SurfaceFile, AnEndingMayBeInCapitals) {
  std::string obj, off = fmt::format("OFF\n{} {} 0\n", ball_.nodes.size(), count_), ply, vtk;
  ply = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      ball_.nodes.size(), count_);
  vtk =
      fmt::format("# vtk DataFile Version 3.0\nball\nASCII\nDATASET POLYDATA\nPOINTS {} double\n", ball_.nodes.size());
  for (const Eigen::Vector3d& x : ball_.nodes) {
    const std::string place = fmt::format("{} {} {}\n", x.x(), x.y(), x.z());
    obj += "v " + place, off += place, ply += place, vtk += place;
  }
  vtk += fmt::format("POLYGONS {} {}\n", count_, 4 * count_);
  for (const auto& [a, b, c] : ball_.triangles) {
    const std::string corners = fmt::format("3 {} {} {}\n", a, b, c);
    obj += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1), off += corners, ply += corners, vtk += corners;
  }
  for (const auto& [name, bytes] : {std::pair{"A.OBJ", obj}, {"A.OFF", off}, {"A.Ply", ply}, {"A.VTK", vtk}})
    expect_ball(write_file(folder_ / name, bytes), 1);
}

TEST_F(SurfaceFile, StripsOfALegacyVtkFileAreTriangles) {
  const std::string head =
      "# vtk DataFile Version 3.0\nbox\nASCII\nDATASET POLYDATA\nPOINTS 8 float\n"
      "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1\n";
  const std::string strip = "TRIANGLE_STRIPS 1 11\n10 0 4 1 5 2 6 3 7 0 4\n",
                    lids = "POLYGONS 2 10\n4 0 1 2 3\n4 4 7 6 5\n";
  for (const std::string& cells : {strip + lids, lids + strip}) {
    const ReadSurface box = read_surface(write_file(folder_ / "box.vtk", head + cells), 1);
    EXPECT_EQ(box.mesh.triangles.size(), 12u);
    EXPECT_NEAR(std::abs(enclosed_volume(box.mesh)), 1, 1e-9) << "neighbours disagree";
  }
  EXPECT_EQ(read_surface(write_file(folder_ / "open.vtk", head + strip), 1).mesh.triangles.size(), 8u);
  EXPECT_NE(
      refusal(write_file(folder_ / "far.vtk", head + "TRIANGLE_STRIPS 1 4\n3 0 1 8\n")).find("names point 8, of 8"),
      std::string::npos);
  EXPECT_NE(
      refusal(write_file(folder_ / "new.vtk", replaced(head, "3.0", "5.1") + lids)).find("version 5 are not read"),
      std::string::npos);
}

TEST_F(SurfaceFile, NamesOfGroupsThatAreNotKeptAreTold) {
  const std::string file =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng lobe\nf 1 3 2\nf 1 2 4\ng\ng lobe\nf 1 4 3\ng vein\nf 2 3 4\n";
  const ReadSurface read = read_surface(write_file(folder_ / "a.obj", file), 1);
  ASSERT_EQ(read.findings.size(), 1u);
  EXPECT_EQ(say(read.findings[0]),
            "groups of triangles (2), the first 'lobe': not kept: --group names nodes by their place");
}

TEST_F(SurfaceFile, AnStlFileIsWhatItHoldsAndNotWhatItSays) {
  const ReadSurface called_text =
      read_surface(write_file(folder_ / "a.stl", binary_stl(ball_, "solid liver", count_)), 1);
  ASSERT_EQ(called_text.findings.size(), 1u);
  EXPECT_NE(say(called_text.findings[0]).find("first line is that of a text file"), std::string::npos);
  EXPECT_EQ(called_text.mesh.triangles.size(), count_);
  for (const std::uint32_t told : {0u, count_ + 7, 4000000000u}) {
    const ReadSurface lying = read_surface(write_file(folder_ / "b.stl", binary_stl(ball_, "made by hand", told)), 1);
    ASSERT_EQ(lying.findings.size(), 1u);
    EXPECT_NE(say(lying.findings[0]).find("announces " + std::to_string(told)), std::string::npos);
    EXPECT_EQ(lying.mesh.triangles.size(), count_);
  }
}

TEST_F(SurfaceFile, DamageIsRefusedWithItsPlace) {
  const std::string text = text_stl(ball_);
  EXPECT_NE(refusal(write_file(folder_ / "cut.stl", text.substr(0, text.find("endloop", 2000)))).find("triangle "),
            std::string::npos);
  std::string word = text;
  word.replace(word.find("vertex ") + 7, 4, "soft");
  EXPECT_NE(refusal(write_file(folder_ / "word.stl", word)).find("triangle 0: \"soft"), std::string::npos);
  TriangleMesh hole = ball_;
  hole.nodes[hole.triangles[3][1]].x() = std::nan("");
  EXPECT_NE(refusal(write_file(folder_ / "nan.stl", binary_stl(hole, "", count_))).find("not a finite number"),
            std::string::npos);
  EXPECT_NE(refusal(write_file(folder_ / "empty.stl", "")).find("too short"), std::string::npos);
  EXPECT_NE(refusal(write_file(folder_ / "far.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 99\n")).find("far.off: "),
            std::string::npos);
  EXPECT_NE(refusal(write_file(folder_ / "huge.off", "OFF\n900000000000 1 0\n0 0 0\n")).find("huge.off: "),
            std::string::npos);
  EXPECT_NE(refusal(write_file(folder_ / "a.step", "ISO")).find("is read from .stl"), std::string::npos);
  EXPECT_NE(refusal(folder_ / "none.stl").find("does not exist"), std::string::npos);
  const std::string head =
      R"(<VTKFile type="PolyData" compressor="vtkZLibDataCompressor"><PolyData><Piece><Points><DataArray type="Float32" Name="p" format="binary">)";
  EXPECT_NE(refusal(write_file(folder_ / "cut.vtp", head + "AQAAAACAAAA")).find("cut.vtp: "), std::string::npos);
  EXPECT_NE(refusal(write_file(folder_ / "lie.vtp", head + "/////////////////////w==</DataArray>")).find("lie.vtp: "),
            std::string::npos);
}

}  // namespace
}  // namespace palpate

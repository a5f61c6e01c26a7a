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

/// A prism of height 1 on a polygon that goes round to the left.
struct Prism {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<int>> faces;
};

Prism prism_on(const std::vector<Eigen::Vector2d>& polygon) {
  Prism prism{{}, {{}, {}}};
  const int n = static_cast<int>(polygon.size());
  for (const int z : {0, 1})
    for (const Eigen::Vector2d& x : polygon) prism.points.emplace_back(x.x(), x.y(), z);
  for (int i = 0; i < n; ++i) {
    prism.faces[0].insert(prism.faces[0].begin(), i);
    prism.faces[1].push_back(n + i);
    prism.faces.push_back({i, (i + 1) % n, n + (i + 1) % n, n + i});
  }
  return prism;
}

TEST_F(SurfaceFile, AConcavePolygonIsCutWithoutOverlap) {
  std::vector<Eigen::Vector2d> u{{0, 0}, {6, 0}, {6, 6}, {4, 6}, {4, 2}, {2, 2}, {2, 6}, {0, 6}};
  for (std::size_t turn = 0; turn < u.size(); ++turn, std::ranges::rotate(u, u.begin() + 1)) {
    const Prism prism = prism_on(u);
    std::string obj;
    for (const Eigen::Vector3d& x : prism.points) obj += fmt::format("v {} {} {}\n", x.x(), x.y(), x.z());
    for (const auto& face : prism.faces) {
      obj += "f";
      for (const int n : face) obj += fmt::format(" {}", n + 1);
      obj += "\n";
    }
    const ReadSurface read = read_surface(write_file(folder_ / "u.obj", obj), 1);
    EXPECT_NEAR(enclosed_volume(read.mesh), 28, 1e-9);
    EXPECT_NEAR(surface_area(read.mesh), 2 * 28 + 32, 1e-9) << "triangles overlap";
  }
}

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

TEST_F(SurfaceFile, LegalLinesOfAnObjFileAreReadOrPassedOver) {
  const auto read_as = [&](const std::string& text) { return read_surface(write_file(folder_ / "a.obj", text), 1); };
  const auto volume = [&](const std::string& text) { return enclosed_volume(read_as(text).mesh); };
  EXPECT_NEAR(volume(replaced(kObj, "f 2 3 4", "f 2 \\\n 3 \\\r\n4")), 1.0 / 6, 1e-9);
  EXPECT_NEAR(volume(replaced(kObj, "v 1 0 0", "v\t1\t0\t0")), 1.0 / 6, 1e-9);
  EXPECT_NEAR(volume(replaced(kObj, "v 1 0 0", "v 1 0 0 0.5 0.5 1 # red")), 1.0 / 6, 1e-9);
  EXPECT_NEAR(volume(replaced(kObj, "f 2 3 4", "f -3//1 -2//2 -1//3")), 1.0 / 6, 1e-9);
  const ReadSurface lines = read_as(kObj + "l 1 2\nl 2 3\np 1\n");
  EXPECT_EQ(lines.mesh.triangles.size(), 4u);
  ASSERT_EQ(lines.findings.size(), 1u);
  EXPECT_EQ(say(lines.findings[0]), "lines that say nothing of polygons (3), the first line 9, 'l': passed over");
}

TEST_F(SurfaceFile, DamageIsRefusedWithItsLineOrElement) {
  const std::string off =
      "OFF\n# made by hand\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n" +
      off.substr(off.find("0 0 0"));
  struct Damage {
    const char* name;
    std::string text, was, is, said;
  };
  for (const Damage& d :
       std::vector<Damage>{{"z.obj", kObj, "v 0 0 1", "v 0 0 30,5", "line 4: \"30,5\" stands where a finite number"},
                           {"y.obj", kObj, "v 0 0 1", "v 0 0,5 1", "line 4: \"0,5\" stands"},
                           {"w.obj", kObj, "v 0 0 1", "v 0 0 1 x", "line 4: \"x\" stands"},
                           {"few.obj", kObj, "v 0 0 1", "v 0 0", "line 4: it ends where a number should stand"},
                           {"far.obj", kObj, "f 2 3 4", "f 2 3 99", "line 8: a face names vertex 99, of 4"},
                           {"zero.obj", kObj, "f 2 3 4", "f 0 3 4", "line 8: a face names vertex 0, of 4"},
                           {"cut.obj", kObj, "f 2 3 4", "f 2 3", "line 8: a face has 2 corners"},
                           {"z.off", off, "0 0 1\n3", "0 0 0,5\n3", "line 7: \"0,5\" stands"},
                           {"far.off", off, "3 1 2 3", "3 1 2 9", "line 11: face 3 of 4 names vertex 9, of 4"},
                           {"cut.off", off, "3 1 2 3\n", "", "the file ends before "},
                           {"kind.off", off, "OFF", "4OFF", "line 1: \"4OFF\" stands where OFF should"},
                           {"z.ply", ply, "0 0 1\n3", "0 0 0,5\n3", "vertex 3 of 4: \"0,5\" stands"},
                           {"far.ply", ply, "3 1 2 3", "3 1 2 9", "face 3 names vertex 9, of 4"},
                           {"cut.ply", ply, "3 1 2 3", "3 1", "face 3 of 4: "},
                           {"type.ply", ply, "float z", "half z", "line 6: \"half\" is no type"}}) {
    EXPECT_EQ(refusal(write_file(folder_ / d.name, d.text)), "read") << d.name;
    const std::string said = refusal(write_file(folder_ / d.name, replaced(d.text, d.was, d.is)));
    EXPECT_NE(said.find(d.name + std::string(": ") + d.said), std::string::npos) << said;
  }
}

template <class T>
void put_big(std::string& bytes, T value) {
  for (int shift = 8 * (sizeof(T) - 1); shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
}

TEST_F(SurfaceFile, NumbersOfAPlyFileMayBeOfAnyTypeAndOrder) {
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement face 4\nproperty uchar quality\nproperty list ushort short "
      "vertex_index\nelement vertex 4\nproperty short x\nproperty short y\nproperty int z\nproperty list uchar uchar "
      "more\nend_header\n";
  for (const auto& [a, b, c] : std::vector<std::array<int, 3>>{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
    bytes += '\7';
    for (const int n : {3, a, b, c}) put_big(bytes, static_cast<std::int16_t>(n));
  }
  for (const auto& [x, y, z] : std::vector<std::array<int, 3>>{{0, 0, 0}, {300, 0, 0}, {0, 300, 0}, {0, 0, -300}}) {
    put_big(bytes, static_cast<std::int16_t>(x)), put_big(bytes, static_cast<std::int16_t>(y)), put_big(bytes, z);
    bytes += "\2ab";
  }
  EXPECT_NEAR(enclosed_volume(read_surface(write_file(folder_ / "a.ply", bytes), 1).mesh), -4.5e6, 1e-3);
}

TEST_F(SurfaceFile, AnStlFileMayBeInCapitals) {
  std::string text = text_stl(ball_);
  for (char& c : text) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  expect_ball(write_file(folder_ / "a.stl", text), 1);
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

// Surfaces in every format, spoilt: they are read and repaired, or refused in a sentence that names the file.
#include "tests/fuzz/spoil.hpp"
#include "tests/organ/surfaces_for_tests.hpp"
#include "tools/organ/surface_file.hpp"
#include "tools/organ/surface_repair.hpp"

namespace palpate {
namespace {

using namespace testing;

const std::string kPlaces = "0 0 0\n0.1 0 0\n0 0.1 0\n0 0 0.1\n", kFaces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

std::string obj() {
  return "# by hand\nv 0 0 0 1 1 1\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 \\\n0.1\ng all\nl 1 2\n"
         "f 1 3 2\nf 1/1 2/2 4/3\nf 1//1 4//1 3//1\nf -3 -2 -1\n";
}

std::string ply_header(const std::string& format, const std::string& number) {
  return "ply\nformat " + format + " 1.0\ncomment by hand\nelement vertex 4\nproperty " + number + " x\nproperty " +
         number + " y\nproperty " + number + " z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string binary_ply() {
  std::string bytes = ply_header("binary_little_endian", "short");
  const auto put = [&](auto number) { bytes.append(reinterpret_cast<const char*>(&number), sizeof number); };
  for (const std::int16_t x : {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}) put(x);
  for (const auto& face : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
    put(std::uint8_t{3});
    for (const std::int32_t n : face) put(n);
  }
  return bytes;
}

std::string vtp() {
  return R"(<?xml version="1.0"?><VTKFile type="PolyData" version="1.0" byte_order="LittleEndian"><PolyData>)"
         R"(<Piece NumberOfPoints="4" NumberOfPolys="4"><Points>)"
         R"(<DataArray type="Float32" Name="Points" NumberOfComponents="3" format="ascii">)" +
         kPlaces + R"(</DataArray></Points><Polys><DataArray type="Int64" Name="connectivity" format="ascii">)" +
         "0 2 1 0 1 3 0 3 2 1 2 3" + R"(</DataArray><DataArray type="Int64" Name="offsets" format="ascii">)" +
         "3 6 9 12</DataArray></Polys></Piece></PolyData></VTKFile>";
}

TEST(SurfaceFuzz, ASurfaceIsReadOrRefusedInWords) {
  const TriangleMesh corner{{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}},
                            {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const std::vector<Sample> samples{
      {"a.obj", obj()},
      {"b.off", "OFF\n4 4 6\n" + kPlaces + kFaces},
      {"c.ply", ply_header("ascii", "float") + kPlaces + kFaces},
      {"d.ply", binary_ply()},
      {"e.stl", text_stl(corner)},
      {"f.stl", binary_stl(corner, "by hand", 4)},
      {"g.vtk", "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n" + kPlaces +
                    "POLYGONS 4 16\n" + kFaces},
      {"h.vtp", vtp()}};
  spoil_all(samples, 800, 6, [](const std::filesystem::path& file) {
    return reads(file, [&] {
      ReadSurface surface = read_surface(file, 1);
      for (const auto& triangle : surface.mesh.triangles)
        for (const int n : triangle) ASSERT_LT(static_cast<std::size_t>(n), surface.mesh.nodes.size());
      try {
        repair_surface(std::move(surface.mesh), 0.2, surface.findings);
      } catch (const std::runtime_error&) {  // it is no body's
      }
    });
  });
}

}  // namespace
}  // namespace palpate

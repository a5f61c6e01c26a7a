// Meshes, motions and scenes with numbers that cannot be, pieces that are gone or come twice, and bytes of no meaning:
// they are read, or refused in a sentence that names the file.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <regex>

#include "common/files/png_file.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/obj_file.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/shell_file.hpp"
#include "common/scene/scene.hpp"
#include "common/tool/trajectory.hpp"
#include "render_node/image.hpp"
#include "tests/fuzz/rounds.hpp"
#include "tests/mesh/literal_files.hpp"
#include "tests/mesh/visual_surfaces.hpp"
#include "tests/scene/full_scene.hpp"
#include "tests/tensors/files_for_tests.hpp"

namespace palpate {
namespace {

using testing::any_of;

struct Sample {
  std::string name, bytes;
};

class TextSpoiler {
 public:
  explicit TextSpoiler(unsigned seed) : random_(seed) {}

  std::string spoil(std::string bytes) {
    if (bytes.empty()) return bytes;
    const std::size_t at = random_() % bytes.size(), length = std::min(bytes.size() - at, 1 + random_() % 60);
    switch (random_() % 6) {
      case 0:
        return bytes.replace(at, length, std::string(random_() % 2, static_cast<char>(random_() % 256)));
      case 1:
        return bytes.insert(random_() % bytes.size(), bytes.substr(at, length));
      case 2:
        return bytes.substr(0, at);
      case 3:
        return with_number_of_bytes(std::move(bytes), at);
      default:
        return with_number(std::move(bytes), at);
    }
  }

 private:
  /// In place of the next one that is written out.
  std::string with_number(std::string text, std::size_t from) {
    const std::size_t begin = text.find_first_of("0123456789", from);
    if (begin == std::string::npos) return text;
    const std::size_t end = std::min(text.find_first_not_of("0123456789.eE+-", begin), text.size());
    static const std::array<const char*, 16> numbers{"nan",
                                                     "inf",
                                                     "-inf",
                                                     "1e308",
                                                     "-1e308",
                                                     "1e999",
                                                     "5e-324",
                                                     "0",
                                                     "-1",
                                                     "2147483647",
                                                     "2147483648",
                                                     "-2147483649",
                                                     "18446744073709551615",
                                                     "9999999999999999999999",
                                                     "0x10",
                                                     "1.5.5"};
    return text.replace(begin, end - begin, any_of(numbers, random_));
  }
  std::string with_number_of_bytes(std::string bytes, std::size_t at) {
    if (bytes.size() < 8) return bytes;
    at = std::min(at, bytes.size() - 8);
    const double number = any_of(testing::kExtremeNumbers, random_);
    const std::int32_t whole = any_of(testing::kExtremeIntegers, random_);
    random_() % 2 ? std::memcpy(&bytes[at], &number, 8) : std::memcpy(&bytes[at], &whole, 4);
    return bytes;
  }

  std::mt19937 random_;
};

/// Reads it, or says why not with the file's name in front.
template <class Read>
bool reads(const std::filesystem::path& file, Read&& read) {
  try {
    read();
    return true;
  } catch (const std::runtime_error& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with(file.string() + ":")) << error.what();
    return false;
  }
}

/// Spoils each sample in turn, some of them more than once.
template <class Read>
void spoil_all(const std::vector<Sample>& samples, int rounds, unsigned seed, Read&& read) {
  const testing::TemporaryFolder folder;
  TextSpoiler spoiler(seed);
  int whole = 0, done = 0;
  testing::fuzz(rounds, 1, [&](int round) {
    const Sample& sample = samples[round % samples.size()];
    std::string bytes = spoiler.spoil(sample.bytes);
    for (int more = round % 3; more > 0; --more) bytes = spoiler.spoil(bytes);
    const auto file = folder / sample.name;  // lies there where the test does not live to tell
    testing::write_bytes(file, {bytes.begin(), bytes.end()}, bytes.size());
    SCOPED_TRACE(fmt::format("round {}, {}", round, sample.name));
    whole += read(file);
    ++done;
  });
  fmt::print("{} files, {} of them read\n", done, whole);
  EXPECT_LT(whole, done);
}

TEST(MeshFuzz, AMeshIsReadOrRefusedInWords) {
  setenv("PALPATE_CACHE", "/dev/null", 1);  // readings of spoiled files are not kept
  const std::vector<Sample> samples{{"a.msh", kGmsh1},
                                    {"b.msh", kGmsh2},
                                    {"c.msh", gmsh2_binary()},
                                    {"d.msh", kGmsh4},
                                    {"e.msh", gmsh4_binary()},
                                    {"f.vtk", kVtk},
                                    {"g.vtk", vtk_binary<double>("double")},
                                    {"h.stl", kStl}};
  spoil_all(samples, 160, 1, [](const std::filesystem::path& file) {
    const bool solid = reads(file, [&] { check_tet_mesh(load_tet_mesh(file, 1), file.string()); });
    const bool shell = reads(file, [&] { load_shell_mesh(file, 1); });
    return reads(file, [&] { load_triangle_mesh(file, 1); }) || solid || shell;
  });
}

/// A visual surface, its materials and its image.
TEST(VisualFuzz, AVisualSurfaceIsReadOrRefusedInWords) {
  const testing::TemporaryFolder folder;
  const VisualMesh mesh = ellipsoid_around({0.05, 0.04, 0.03}, 3, 5);
  write_obj(mesh, folder / "a.obj", 1e-3, 3);
  write_mtl(mesh, folder / "a.mtl", "a.png");
  Image image{16, 8, std::vector<std::uint8_t>(std::size_t{4} * 16 * 8, 99)};
  write_png(image, folder / "a.png");
  const ObjMaterials materials = load_mtl(folder / "a.mtl");
  std::vector<Sample> samples;
  for (const char* name : {"a.obj", "a.mtl", "a.png"}) {
    const auto bytes = testing::read_bytes(folder / name);
    samples.push_back({name, {bytes.begin(), bytes.end()}});
  }
  spoil_all(samples, 3000, 4, [&](const std::filesystem::path& file) {
    return reads(file, [&] {
      if (file.extension() == ".obj") {
        const VisualMesh read = load_obj(file, 1e-3, materials, true);
        for (const VisualMesh::Part& part : read.parts)
          for (const auto& triangle : part.triangles)
            for (const int vertex : triangle) ASSERT_TRUE(vertex >= 0 && vertex < part.count);
      } else if (file.extension() == ".mtl") {
        load_mtl(file);
      } else {
        decode_png(read_png_bytes(file, kMaxTextureSide), file);
      }
    });
  });
}

TEST(MotionFuzz, AMotionIsReadOrRefusedInWords) {
  const Sample motion{
      "motion.csv",
      "time,yaw,pitch,depth,roll,grip,pedal\n0,0,0,0.17,0,0,0\n0.5,0,0,0.18,0,0,1\n1.0,0,0.1,0.2,0,0,0\n"};
  spoil_all({motion}, 2000, 2, [](const std::filesystem::path& file) {
    return reads(file, [&] {
      const Trajectory trajectory = load_trajectory(file);
      for (const double t : {0.0, 0.3, 0.75, 1e9}) {
        const ToolDofs dofs = trajectory.at(t);
        EXPECT_TRUE(std::isfinite(dofs.yaw + dofs.pitch + dofs.depth + dofs.roll + dofs.grip));
      }
    });
  });
}

TEST(SceneFileFuzz, ASceneIsReadOrRefusedInWords) {
  const SceneFolder folder;  // what they name is there
  const auto place = folder / "scene.toml";
  spoil_all({{"a.toml", kFullScene}, {"b.toml", kMinimalScene}}, 2000, 3, [&](const std::filesystem::path& file) {
    const auto bytes = testing::read_bytes(file);
    return reads(place, [&] { parse_scene({bytes.begin(), bytes.end()}, place); });
  });
}

}  // namespace
}  // namespace palpate

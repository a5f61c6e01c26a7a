#include "common/scene/ensure_archive.hpp"

#include <gtest/gtest.h>

#include "common/archive/static_solve.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/surface.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "common/scene/find_archive.hpp"
#include "tests/fem/meshes_for_tests.hpp"
#include "tests/tensors/files_for_tests.hpp"

namespace palpate {
namespace {

/// Gmsh 2.2 ASCII, the least there is to write.
void write_mesh(const TetMesh& mesh, const std::filesystem::path& file) {
  std::ofstream out(file);
  out.precision(17);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << mesh.nodes.size() << "\n";
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) out << i + 1 << " " << mesh.nodes[i].transpose() << "\n";
  out << "$EndNodes\n$Elements\n" << mesh.tetrahedra.size() << "\n";
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    out << e + 1 << " 4 2 1 1";
    for (int node : mesh.tetrahedra[e]) out << " " << node + 1;
    out << "\n";
  }
  out << "$EndElements\n";
}

class EnsureArchive : public ::testing::Test {
 protected:
  EnsureArchive() {
    unsetenv("PALPATE_CACHE");
    write_mesh(mesh, folder / "organ.msh");
    scene.file = folder / "scene.toml";
    auto body = testing::make_body();
    BoundaryCondition base;
    base.where.indices = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    body.fixed = {base};
    body.mesh = folder / "organ.msh";
    scene.bodies = {body};
  }
  Body& body() { return scene.bodies[0]; }
  SolidSpec& solid() { return *as<SolidSpec>(body()); }
  /// Makes the body one of another kind.
  template <class Kind>
  Kind& turn_into() {
    Kind spec;
    static_cast<SolidSpec&>(spec) = solid();
    return body().emplace<Kind>(std::move(spec));
  }

  testing::TemporaryFolder folder;
  TetMesh mesh = testing::make_organ({3, 3, 2});
  Scene scene;
};

TEST_F(EnsureArchive, ComputesOnceAndIsUpToDateAfterwards) {
  const auto first = ensure_archive(scene, body());
  EXPECT_FALSE(first.up_to_date);
  EXPECT_TRUE(ensure_archive(scene, body()).up_to_date);
  const auto archive = find_archive(scene, body(), ArchivePart::surface);
  const auto expected = precompute(with_offline(std::get<QuasiStaticSpec>(body()), mesh), mesh);
  EXPECT_EQ(archive.surface.node_number, expected.surface.node_number);
  ASSERT_EQ(archive.touchable_compliance.size(), expected.touchable_compliance.size());
  for (std::size_t i = 0; i < archive.touchable_compliance.size(); ++i)
    ASSERT_NEAR(archive.touchable_compliance[i], expected.touchable_compliance[i],
                1e-12 * std::abs(expected.touchable_compliance[0]));
}

TEST_F(EnsureArchive, SeveralBehavioursOfOneGeometryLiveSideBySide) {
  const auto soft = ensure_archive(scene, body()).file;
  solid().material.poisson = 0.3;
  const auto thinning = ensure_archive(scene, body()).file;
  EXPECT_NE(soft, thinning);
  EXPECT_TRUE(std::filesystem::exists(soft));
}

TEST_F(EnsureArchive, OneFileServesEveryYoungsModulus) {
  const auto soft = ensure_archive(scene, body());
  const auto a = find_archive(scene, body(), ArchivePart::touchable);
  solid().material.young *= 2;
  const auto stiff = ensure_archive(scene, body());
  EXPECT_TRUE(stiff.up_to_date);
  EXPECT_EQ(soft.file, stiff.file);
  const auto b = find_archive(scene, body(), ArchivePart::touchable);
  EXPECT_EQ(b.young[0], solid().material.young);
  EXPECT_NE(a.content_hash, b.content_hash);
  EXPECT_NEAR(a.touchable_compliance[0], 2 * b.touchable_compliance[0], 1e-12 * a.touchable_compliance[0]);
}

TEST_F(EnsureArchive, RebuildsWhatIsRefusedAndSaysWhy) {
  const auto file = ensure_archive(scene, body()).file;
  const auto good = testing::read_bytes(file);
  testing::write_bytes(file, good, good.size() / 2);
  auto state = ensure_archive(scene, body());
  EXPECT_NE(state.refused.find("truncated"), std::string::npos);
  EXPECT_EQ(testing::refusal(file), "");

  auto stale = read_archive(file, ArchivePart::surface, {});
  stale.content_hash = "of another body";
  write_archive(stale, file);
  state = ensure_archive(scene, body());
  EXPECT_NE(state.refused.find("made for another mesh"), std::string::npos);
  EXPECT_TRUE(ensure_archive(scene, body()).up_to_date);
}

TEST_F(EnsureArchive, RunTimeAsksForAPrecomputationInWords) {
  try {
    find_archive(scene, body(), ArchivePart::touchable);
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("palpate precompute"), std::string::npos);
  }
}

TEST_F(EnsureArchive, StoresTheTetrahedraOfBodiesThatMoveWithInertia) {
  MaterialRegion dense;
  dense.where.indices = {0, 1, 2};
  dense.material = {5e4, 0.3, 1300};
  solid().materials = {dense};
  for (const bool springs : {false, true}) {
    if (springs)
      turn_into<SpringMassSpec>();
    else
      turn_into<TensorMassSpec>();
    const auto archive = load_or_precompute(scene, ArchivePart::surface)[0];
    EXPECT_EQ(archive.model, springs ? "spring_mass" : "tensor_mass");
    EXPECT_EQ(archive.density, (std::vector<double>{1000, 1300}));
    EXPECT_EQ(archive.material_of_element.size(), mesh.tetrahedra.size());
    EXPECT_TRUE(archive.touchable_compliance.empty());
    EXPECT_TRUE(archive.touchable_dofs.empty());
    const auto& map = archive.surface;
    ASSERT_EQ(map.size(), static_cast<int>(mesh.nodes.size()));
    EXPECT_LT(map.touchable, map.size());
    ASSERT_EQ(archive.tetrahedra.size(), mesh.tetrahedra.size());
    for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e)
      for (int v = 0; v < 4; ++v) EXPECT_EQ(map.node_number[archive.tetrahedra[e][v]], mesh.tetrahedra[e][v]);
    // Touchable nodes, other surface nodes, inner ones; each group ascends.
    const auto surface = extract_surface(mesh);
    const auto on_surface = [&](int node) { return std::ranges::binary_search(surface.nodes, node); };
    const auto middle = map.node_number.begin() + map.touchable,
               inner = map.node_number.begin() + static_cast<long>(surface.nodes.size());
    EXPECT_TRUE(std::is_sorted(map.node_number.begin(), middle));
    EXPECT_TRUE(std::is_sorted(middle, inner) && std::all_of(map.node_number.begin(), inner, on_surface));
    EXPECT_TRUE(std::is_sorted(inner, map.node_number.end()) && std::none_of(inner, map.node_number.end(), on_surface));
  }
}

TEST_F(EnsureArchive, BuildsHybridBodiesFromRegionsAndFromASecondMesh) {
  auto& hybrid = turn_into<HybridSpec>().hybrid;
  hybrid.regions.push_back({{{20, 21, 22, 23, 24, 25}, {}, ""}});
  EXPECT_FALSE(ensure_archive(scene, body()).up_to_date);
  EXPECT_TRUE(ensure_archive(scene, body()).up_to_date);
  const auto archive = find_archive(scene, body(), ArchivePart::surface);
  EXPECT_EQ(archive.tetrahedra.size(), 6u);
  EXPECT_GT(archive.condensed->connection.size(), 3u);
  EXPECT_GT(archive.touchable_compliance.size(), 0u);

  write_mesh(make_block({0, 0, 0}, {0.04, 0.04, 0.02}, {2, 2, 1}), folder / "organ.msh");
  write_mesh(make_block({0, 0, 0.02}, {0.04, 0.04, 0.04}, {1, 1, 1}), folder / "coarse.msh");
  solid().fixed[0].where.indices = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  hybrid.regions.clear();
  hybrid.mesh = folder / "coarse.msh";
  const auto joined = load_or_precompute(scene, ArchivePart::surface)[0];
  EXPECT_EQ(joined.tetrahedra.size(), 6u);
  EXPECT_EQ(joined.condensed->connection.size(), 4u);
  EXPECT_GT(joined.condensed->gap.size(), 0u);
}

TEST_F(EnsureArchive, StaticSolveByTensorsIsRefusedForBodiesThatMoveWithInertia) {
  turn_into<TensorMassSpec>();
  const auto archive = load_or_precompute(scene, ArchivePart::surface)[0];
  EXPECT_THROW(solve_tensors(archive, {hold(archive.surface.node_number[0], 0, 1e-3)}), std::runtime_error);
}

TEST_F(EnsureArchive, StoresMaterialRegionsAndSpecimen) {
  MaterialRegion half;
  half.where.indices = {0, 1, 2};
  half.material = {5e4, 0.3, 1000};
  solid().materials = {half};
  write_mesh(make_cylinder(0.015, 0.013, 3, 2), folder / "specimen.msh");
  std::get<QuasiStaticSpec>(body()).nonlinear = Nonlinear{MeasuredLaw{.specimen_mesh = folder / "specimen.msh"}};
  const auto archives = load_or_precompute(scene, ArchivePart::header);
  ASSERT_EQ(archives.size(), 1u);
  EXPECT_EQ(archives[0].young, (std::vector<double>{10e3, 5e4}));
  EXPECT_EQ(archives[0].material_of_element.size(), mesh.tetrahedra.size());
  EXPECT_EQ(archives[0].material_of_element[2], 1);
  EXPECT_EQ(archives[0].material_of_element[3], 0);
  EXPECT_GT(archives[0].specimen_force_slope, 0);
}

}  // namespace
}  // namespace palpate

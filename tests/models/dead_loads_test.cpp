// Dead loads and weight of a scene's bodies: what each kind of tissue makes of them is the static solution.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/archive/static_solve.hpp"
#include "common/fem/body_loads.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/shell_generators.hpp"
#include "common/mesh/surface.hpp"
#include "common/models/modal_shell/precompute.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "common/models/static_state.hpp"
#include "common/models/tensor_mass/spec.hpp"
#include "common/view/visual_body.hpp"
#include "tests/dynamics/hybrid_bodies.hpp"
#include "tests/tensors/files_for_tests.hpp"
#include "tools/rig/kinds.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using namespace testing;

const Vector3d kGravity(0.5, 0, -9.81);

TetMesh block() {
  return make_hybrid_block({4, 3, 4}, 0.01);
}

/// 60 mN on the top together, and 40 Pa against the side x = 0.
std::vector<LoadSpec> top_and_side() {
  LoadSpec top, side;
  top.where.group = "top";
  top.force = {0.02, 0, -0.06};
  side.where.box = Box{{-1e-6, -1, -1}, {1e-6, 1, 1}};
  side.pressure = 40;
  return {top, side};
}

/// The same by hand [N], per node: an even share of the force; a third of each triangle's pressure at its corners.
std::vector<Vector3d> by_hand(const TetMesh& mesh) {
  std::vector<Vector3d> load(mesh.nodes.size(), Vector3d::Zero());
  const std::vector<int>& top = mesh.groups.at("top").nodes;
  for (const int n : top) load[n] += Vector3d(0.02, 0, -0.06) / static_cast<double>(top.size());
  const auto on_side = [&](int n) { return std::abs(mesh.nodes[n].x()) < 1e-6; };
  for (const auto& t : extract_surface(mesh).triangles) {
    if (!std::ranges::all_of(t, on_side)) continue;
    const double area = 0.5 * (mesh.nodes[t[1]] - mesh.nodes[t[0]]).cross(mesh.nodes[t[2]] - mesh.nodes[t[0]]).norm();
    for (const int n : t) load[n] += Vector3d(40 * area / 3, 0, 0);  // outward is along -x
  }
  return load;
}

std::vector<Vector3d> with_weight(std::vector<Vector3d> load, const StaticProblem& problem) {
  const auto weight = weights(problem, kGravity);
  for (std::size_t n = 0; n < load.size(); ++n) load[n] += weight[n];
  return load;
}

std::vector<Vector3d> on_surface(const SurfaceMap& surface, const std::vector<Vector3d>& of_mesh) {
  std::vector<Vector3d> field;
  for (const int node : surface.node_number) field.push_back(of_mesh[node]);
  return field;
}

QuasiStaticSpec loaded_body() {
  QuasiStaticSpec body = make_body(5e3, 0.4);
  body.loads = top_and_side();
  body.gravity = kGravity;
  return body;
}

TEST(DeadLoads, MoveAQuasiStaticBodyAsTheFullSystemSays) {
  const TetMesh mesh = block();
  const Archive archive = precompute(loaded_body(), mesh, nullptr);
  const auto problem = make_static_problem(loaded_body(), mesh);
  const auto rest = solve_loads(problem, with_weight(by_hand(mesh), problem)).displacement;
  EXPECT_LT(relative_difference(archive.sag, on_surface(archive.surface, rest)), 1e-9);
  EXPECT_TRUE(archive.load.empty());
}

TEST(DeadLoads, OfQuadraticElementsBendMore) {
  const TetMesh mesh = block();
  QuasiStaticSpec fine = loaded_body();
  fine.offline = Offline{.element = FiniteElement::p2};
  const auto largest = [&](const QuasiStaticSpec& body) {
    double most = 0;
    for (const Vector3d& u : precompute(body, mesh, nullptr).sag) most = std::max(most, u.norm());
    return most;
  };
  EXPECT_GT(largest(fine), 1.02 * largest(loaded_body()));
  EXPECT_LT(largest(fine), 1.5 * largest(loaded_body()));
}

TEST(DeadLoads, AreInTheShapeThatToolsTouchAndFollowYoung) {
  const TetMesh mesh = block();
  QuasiStaticSpec body = loaded_body();
  const Archive stored = precompute(body, mesh, nullptr);
  body.material.young *= 2;
  Archive archive = stored;
  fit_archive(body, archive);
  for (int n = 0; n < stored.surface.size(); ++n) {
    EXPECT_LT((archive.sag[n] - 0.5 * stored.sag[n]).norm(), 1e-15);
    EXPECT_LT((archive.surface.position[n] - stored.surface.position[n] - 0.5 * stored.sag[n]).norm(), 1e-15);
  }
}

TEST(DeadLoads, MoveWhatIsDrawnInPlaceOfTheSurface) {
  const TemporaryFolder folder;
  const TetMesh mesh = block();
  QuasiStaticSpec body = loaded_body();
  body.visual = VisualSpec{.surface = folder / "block.obj"};
  {
    std::ofstream obj(body.visual->surface);
    for (const Vector3d& x : mesh.nodes) obj << fmt::format("v {} {} {}\n", x.x(), x.y(), x.z());
    for (const auto& [a, b, c] : extract_surface(mesh).triangles)
      obj << fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  }
  Archive archive = precompute(body, mesh, nullptr);
  fit_archive(body, archive);
  const auto visual = load_visual(body, archive, Vector3d::Zero());
  ASSERT_TRUE(visual);
  for (const Eigen::Vector3f& x : visual->mesh.position) {
    double nearest = 1;
    for (const Vector3d& node : archive.surface.position) nearest = std::min(nearest, (node - x.cast<double>()).norm());
    EXPECT_LT(nearest, 1e-6);
  }
}

TEST(DeadLoads, LeaveTheShapeFromWhichStaticStatesCount) {
  const TetMesh mesh = block();
  const TemporaryFolder folder;
  QuasiStaticSpec body = loaded_body();
  body.mesh = folder / "block.msh";
  write_tet_mesh(mesh, body.mesh);
  const DirectProblem problem = direct_problem(body);
  const Archive archive = precompute(with_offline(body, mesh), mesh, nullptr);
  EXPECT_LT(relative_difference(archive.sag, on_surface(archive.surface, problem.solve({}, problem.rest).displacement)),
            1e-9);
}

TEST(DeadLoads, MoveAShellAsItsCompliance) {
  const ShellMesh mesh = make_tube(0.01, 0.06, 16, 8);
  ModalShellSpec loaded;
  loaded.name = "duct";
  loaded.material = {2e5, 0.4, 1050};
  loaded.shell = {.thickness = 0.001, .modes = 10};
  ShellBoundaryCondition end;
  end.where.box = Box{{-1, -1, -1}, {1, 1, 1e-6}};
  loaded.fixed = {end};
  LoadSpec pull;
  pull.where.box = Box{{-1, -1, -1}, {1, 1, 1}};
  pull.force = {0.01, -0.02, 0};
  loaded.loads = {pull};
  loaded.gravity = kGravity;
  const Archive archive = precompute(loaded, mesh);
  std::vector<NodalLoad> loads;
  const double used = archive.surface.size();
  for (int n = 0; n < archive.surface.touchable; ++n)
    loads.push_back({archive.surface.node_number[n], pull.force / used + archive.modal->mass[n] * kGravity});
  EXPECT_LT(relative_difference(archive.sag, solve_tensors(archive, {}, loads).displacement), 1e-8);
}

TEST(DeadLoads, TakeMovingTissueToTheirStaticSolution) {
  const TetMesh mesh = block();
  TensorMassSpec body;
  static_cast<SolidSpec&>(body) = make_body(5e3, 0.4);
  body.loads = top_and_side();
  const Archive archive = precompute_on(body, mesh);
  EXPECT_TRUE(archive.sag.empty());
  TensorMass<double> model(elastic_mesh(archive), Integrator::rk4, 80);
  model.set_gravity(kGravity);
  const double dt = 0.9 * max_step(Integrator::rk4, model.frequency_bound(), 0);
  for (int i = 0; i < 0.8 / dt; ++i) model.step(dt);
  const auto problem = make_static_problem(body, mesh);
  const auto rest = solve_loads(problem, with_weight(by_hand(mesh), problem)).displacement;
  std::vector<Vector3d> ours;
  for (int n = 0; n < archive.surface.size(); ++n) ours.push_back(model.displacement(n));
  EXPECT_LT(relative_difference(ours, on_surface(archive.surface, rest)), 1e-4);
}

TEST(DeadLoads, TakeBothPartsOfAHybridToTheirStaticSolution) {
  const TetMesh mesh = block();
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    HybridSpec body = hybrid_body(random_part(mesh, seed), kGravity);
    body.loads = top_and_side();
    HybridRun<double> run(precompute(body, mesh, nullptr), 0, 80, kGravity);
    run.run(0.8);
    const auto problem = make_static_problem(body, mesh);
    EXPECT_LT(static_difference(run, solve_loads(problem, with_weight(by_hand(mesh), problem))), 1e-4) << seed;
  }
}

TEST(DeadLoads, StayWithWhatIsLeftOfTheTissue) {
  const TetMesh mesh = block();
  TensorMassSpec body;
  static_cast<SolidSpec&>(body) = make_body(5e3, 0.4);
  body.loads = {top_and_side()[0]};
  const Archive archive = precompute_on(body, mesh);
  TensorMass<double> model(elastic_mesh(archive), Integrator::rk4, 80);
  std::vector<int> all(archive.tetrahedra.size());
  std::iota(all.begin(), all.end(), 0);
  model.remove(all);  // no node has mass any more, and none may be flung
  model.step(1e-3);
  for (int n = 0; n < archive.surface.size(); ++n) EXPECT_EQ(model.displacement(n), Vector3d::Zero());
}

TEST(DeadLoads, AreRefusedWhereThereIsNothingToLoad) {
  const TetMesh mesh = block();
  const auto error_of = [&](const LoadSpec& load) -> std::string {
    QuasiStaticSpec body = make_body();
    body.loads = {load};
    try {
      body_loads(body, mesh);
      return {};
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  };
  LoadSpec load;
  load.where.box = Box{{5, 5, 5}, {6, 6, 6}};
  load.force = {0, 0, -1};
  EXPECT_EQ(error_of(load), "body 'organ': [[body.load]] 1 selects no node");
  load.where.box = Box{{-1, -1, -1}, {1, 1, 1}};
  load.force = {0, 1e300, 0};
  EXPECT_EQ(error_of(load), "body 'organ': [[body.load]] 1: a force of 1e+300 N, more than there is");
  load.where = {{0}, {}, ""};
  load.force.setZero();
  load.pressure = 10;
  EXPECT_EQ(error_of(load), "body 'organ': [[body.load]] 1: none of its nodes make a triangle of the surface");
}

}  // namespace
}  // namespace palpate

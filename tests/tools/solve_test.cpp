#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "common/mesh/mesh_file.hpp"
#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using testing::OwnFolder;
using testing::program;
using testing::run_program;

struct Row {
  Vector3d position, displacement, force;
};
using Table = std::map<int, Row>;

Table read_table(const fs::path& file) {
  std::istringstream in(testing::text_of(file));
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "node,x,y,z,ux,uy,uz,fx,fy,fz");
  Table table;
  while (std::getline(in, line)) {
    std::vector<double> v;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) v.push_back(std::stod(cell));
    EXPECT_EQ(v.size(), 10u) << line;
    if (v.size() == 10) table[static_cast<int>(v[0])] = {{v[1], v[2], v[3]}, {v[4], v[5], v[6]}, {v[7], v[8], v[9]}};
  }
  return table;
}

int nearest_node(const TetMesh& mesh, const Vector3d& point) {
  const auto closer = [&](const Vector3d& a, const Vector3d& b) { return (a - point).norm() < (b - point).norm(); };
  return static_cast<int>(std::ranges::min_element(mesh.nodes, closer) - mesh.nodes.begin());
}

/// `palpate solve` with archives in a folder of the test's own.
class ToolsSolve : public ::testing::Test {
 protected:
  void SetUp() override { setenv("PALPATE_CACHE", (folder_ / "cache").c_str(), 1); }

  Table solve(const fs::path& scene, const std::string& method, const std::vector<std::string>& holds,
              const std::vector<std::string>& forces = {}) {
    const fs::path csv = folder_ / (method.substr(0, method.find(' ')) + ".csv");
    std::string command =
        fmt::format("{} solve {} --method {} --csv {}", program("palpate"), scene.string(), method, csv.string());
    for (const std::string& hold : holds) command += " --hold " + hold;
    for (const std::string& force : forces) command += " --force " + force;
    const auto result = run_program(command);
    EXPECT_EQ(result.status, 0) << result.err;
    return read_table(csv);
  }

  void expect_agreement(const fs::path& scene, const std::vector<std::string>& holds,
                        const std::vector<std::string>& forces = {}) {
    const Table direct = solve(scene, "direct", holds, forces), tensors = solve(scene, "tensors", holds, forces);
    ASSERT_GT(tensors.size(), 50u);
    ASSERT_GT(direct.size(), tensors.size());
    double max_u = 0, max_f = 0, error_u = 0, error_f = 0;
    for (const auto& [node, t] : tensors) {
      ASSERT_TRUE(direct.contains(node));
      const Row& d = direct.at(node);
      EXPECT_EQ(t.position, d.position) << node;
      max_u = std::max(max_u, d.displacement.norm());
      max_f = std::max(max_f, d.force.norm());
      error_u = std::max(error_u, (t.displacement - d.displacement).norm());
      error_f = std::max(error_f, (t.force - d.force).norm());
    }
    ASSERT_GT(max_u, 0.9e-3);
    ASSERT_GT(max_f, 0);
    EXPECT_LT(error_u, 1e-8 * max_u) << holds.size() << " holds";
    EXPECT_LT(error_f, 1e-8 * max_f) << holds.size() << " holds";
  }

  /// A copy of an example scene in the test's folder, with tensors of linear elements, which take a second.
  fs::path linear_elements(const std::string& name) {
    const fs::path scene = fs::path(PALPATE_SOURCE) / "scenes" / (name + ".toml"), copy = folder_ / (name + ".toml");
    std::string text = testing::text_of(scene);
    for (const char* folder : {"\"meshes/", "\"trajectories/", "\"curves/"})
      for (auto at = text.find(folder); at != text.npos; at = text.find(folder, at + 1))
        text.insert(at + 1, scene.parent_path().string() + "/");
    text.insert(text.find("[[body.fixed]]"), "[body.offline]\nelement = \"p1\"\n\n");
    std::ofstream(copy) << text;
    return copy;
  }
  fs::path plate() { return linear_elements("plate"); }
  static TetMesh plate_mesh() { return load_tet_mesh(fs::path(PALPATE_SOURCE) / "scenes/meshes/plate.msh", 1); }

  OwnFolder folder_{"solve"};
};

TEST_F(ToolsSolve, TensorsEqualDirectOnThePlateForOneNodeAndForSeveral) {
  const TetMesh mesh = plate_mesh();
  const auto hold = [&](double x, double y, const std::string& displacement) {
    return fmt::format("{}:{}", nearest_node(mesh, {x, y, 0.008}), displacement);
  };
  const std::string first = hold(0, 0, "0,0,-0.001");
  expect_agreement(plate(), {first});
  expect_agreement(plate(), {first, hold(-0.02, 0.01, "0.0002,0,-0.002"), hold(0.02, 0, "0,-0.0003,-0.001"),
                             hold(0.01, -0.03, "0,0,0.0005")});
}

TEST_F(ToolsSolve, AKeyInPlaceOfTheFilesIsTaken) {
  const std::string command = fmt::format("{} solve {} --force {}:0,0,-0.001 --json", program("palpate"),
                                          plate().string(), nearest_node(plate_mesh(), {0, 0, 0.008}));
  const auto moved = [&](const std::string& more) {
    const auto result = run_program(command + more);
    EXPECT_EQ(result.status, 0) << result.err;
    return nlohmann::json::parse(result.out)["max_displacement_m"].get<double>();
  };
  EXPECT_NEAR(moved(" --set body.young=1000"), 2 * moved(" --set body.young=2000"), 1e-9);
  EXPECT_NEAR(moved(" --set body.young=1000 --method direct"), moved(" --set body.young=1000"), 1e-9);
}

TEST_F(ToolsSolve, SpringsAreNotSolvedForAsElements) {
  testing::expect_refusal(fmt::format("{} solve {}/scenes/plate_cut.toml --set body.model=spring_mass "
                                      "--set body.dynamic.element=linear --force 40:0,0,-0.001 --method direct",
                                      program("palpate"), PALPATE_SOURCE),
                          {"spring_mass", "linear elasticity", "--dynamic"});
}

TEST_F(ToolsSolve, ItsFiguresInJsonAreThoseOfItsTable) {
  const int node = nearest_node(plate_mesh(), {0, 0, 0.008});
  const std::string hold = fmt::format("{}:0,0,-0.001", node);
  const auto result =
      run_program(fmt::format("{} solve {} --hold {} --json", testing::program("palpate"), plate().string(), hold));
  const auto figures = nlohmann::json::parse(result.out);
  const Table table = solve(plate(), "tensors", {hold});
  EXPECT_EQ(figures["method"], "tensors");
  EXPECT_EQ(figures["max_displacement_node"], node);
  EXPECT_NEAR(figures["max_displacement_m"], 0.001, 1e-12);
  EXPECT_NEAR(figures["max_nodal_force_n"], table.at(node).force.norm(), 1e-6 * table.at(node).force.norm());
  EXPECT_FALSE(figures.contains("correction"));
}

TEST_F(ToolsSolve, AHoldWithAnEmptyComponentHoldsTheOtherAxesAlone) {
  const int node = nearest_node(plate_mesh(), {0.015, 0.01, 0.008});
  const std::vector<std::string> some{fmt::format("{}:0.0005,,-0.001", node)},
      all{fmt::format("{}:0.0005,0,-0.001", node)};
  expect_agreement(plate(), some);
  for (const std::string method : {"direct", "tensors"}) {
    const Row row = solve(plate(), method, some).at(node);
    EXPECT_NEAR(row.displacement.x(), 0.0005, 1e-12);
    EXPECT_NEAR(row.displacement.z(), -0.001, 1e-12);
    EXPECT_LT(std::abs(row.force.y()), 1e-9 * row.force.norm()) << method;
    EXPECT_GT(std::abs(row.displacement.y()), 1e-7) << method;
    EXPECT_GT(std::abs(solve(plate(), method, all).at(node).force.y()), 1e-4 * row.force.norm()) << method;
  }
}

// A load alone, several on a node, and a load beside a hold: by both methods alike, and what holds one node at where a
// load moved it to exerts nothing.
TEST_F(ToolsSolve, LoadsMoveWhatIsFreeByBothMethodsAlike) {
  const TetMesh mesh = plate_mesh();
  const int loaded = nearest_node(mesh, {0.015, 0.01, 0.008}), held = nearest_node(mesh, {-0.02, 0, 0.008});
  const std::string load = fmt::format("{}:0.01,0,-0.12", loaded), half = fmt::format("{}:0.005,0,-0.06", loaded);
  expect_agreement(plate(), {}, {load});
  expect_agreement(plate(), {fmt::format("{}:0,0,0.0005", held)}, {half, half});
  const Table alone = solve(plate(), "direct", {}, {load});
  EXPECT_LT((alone.at(loaded).force - Vector3d(0.01, 0, -0.12)).norm(), 1e-9);
  EXPECT_LT(alone.at(loaded).displacement.z(), 0);
  const Vector3d there = alone.at(held).displacement;
  const Table with = solve(plate(), "tensors",
                           {fmt::format("{}:{:.17g},{:.17g},{:.17g}", held, there.x(), there.y(), there.z())}, {load});
  EXPECT_LT(with.at(held).force.norm(), 1e-8);
  testing::expect_refusal(fmt::format("{} solve {} --force 100000:0,0,1", program("palpate"), plate().string()),
                          {"--force", "100000", "not in the mesh"});
  testing::expect_refusal(fmt::format("{} solve {} --force {}:0,,1", program("palpate"), plate().string(), loaded),
                          {"--force", "all of x, y, z"});
  testing::expect_refusal(
      fmt::format("{} solve {} --force 1:0,0,1", program("palpate"), linear_elements("brain_cylinder").string()),
      {"--force", "[body.nonlinear]"});
}

// TVCG99 fig. 10: two nodes near one another, each carried along by what is done to the other.
TEST_F(ToolsSolve, PlainSuperpositionGoesFurtherThanItsNodesAreHeld) {
  const TetMesh mesh = plate_mesh();
  const int node = nearest_node(mesh, {-0.011, 0, 0.008}), other = nearest_node(mesh, {0.011, 0, 0.008});
  const std::string one = fmt::format("{}:0,0,-0.001", node), two = fmt::format("{}:0,0,-0.001", other);
  const auto plain = [&](const std::vector<std::string>& holds) {
    return solve(plate(), "tensors --plain", holds).at(node).displacement.z();
  };
  EXPECT_NEAR(plain({one}), -0.001, 1e-12);
  const Table alone = solve(plate(), "tensors", {two});
  const double carried = alone.at(node).displacement.z();
  EXPECT_LT(carried, -0.0003);
  EXPECT_NEAR(plain({one, two}), -0.001 + carried, 1e-12);
  EXPECT_NEAR(solve(plate(), "tensors", {one, two}).at(node).displacement.z(), -0.001, 1e-12);
  const auto refused = run_program(
      fmt::format("{} solve {} --plain --touch 0,0,0.008:0,0,-0.001", program("palpate"), plate().string()));
  EXPECT_NE(refused.status, 0);
  EXPECT_NE(refused.err.find("--touch excludes --plain"), std::string::npos) << refused.err;
  testing::expect_refusal(
      fmt::format("{} solve {} --plain --method direct --hold {}", program("palpate"), plate().string(), one),
      {"--plain", "--method tensors"});
}

TEST_F(ToolsSolve, AGroupIsHeldNodeByNode) {
  const fs::path scene = linear_elements("brain_cylinder");
  const TetMesh mesh = load_tet_mesh(fs::path(PALPATE_SOURCE) / "scenes/meshes/cylinder.msh", 1);
  for (const std::string method : {"direct", "tensors"}) {
    const Table table = solve(scene, method, {"top:0,,-0.001"});
    double slid = 0;
    for (const int node : mesh.groups.at("top").nodes) {
      EXPECT_LT((table.at(node).displacement - Vector3d(0, table.at(node).displacement.y(), -0.001)).norm(), 1e-12);
      slid = std::max(slid, std::abs(table.at(node).displacement.y()));
    }
    EXPECT_GT(slid, 1e-4) << method;
  }
  testing::expect_refusal(fmt::format("{} solve {} --hold lid:0,0,1", program("palpate"), scene.string()),
                          {"--hold", "no group 'lid'", "top"});
  const int held = mesh.groups.at("top").nodes[0];
  testing::expect_refusal(
      fmt::format("{} solve {} --hold {}:0,0,1 --hold top:0,0,1", program("palpate"), scene.string(), held),
      {"held twice"});
}

// What is fixed carries the weight of all other nodes, whatever elements it is solved by, and a bar hangs by
// rho g L^2 / 2 E.
TEST_F(ToolsSolve, ABodyHangsUnderItsOwnWeight) {
  const fs::path scene = linear_elements("brain_cylinder"), file = folder_ / "bar.toml";
  const double young = 3000, density = 1040, height = 0.013, g = 9.81;
  for (const char* element : {"p1", "p2"}) {
    std::string text = testing::text_of(scene);
    const auto nonlinear = text.find("[body.nonlinear]");
    text.erase(nonlinear, text.find("\n[", nonlinear) - nonlinear);
    const auto replace = [&](const std::string& what, const std::string& by) {
      ASSERT_NE(text.find(what), text.npos) << what;
      text.replace(text.find(what), what.size(), by);
    };
    replace("poisson = 0.45", "poisson = 0");
    replace("element = \"p1\"", fmt::format("element = \"{}\"", element));
    std::ofstream(file) << text;
    const Table table = solve(file, "direct --gravity 0 0 -9.81", {});
    double sag = 0, carried = 0, sum = 0;
    for (const auto& [node, row] : table) {
      sag = std::min(sag, row.displacement.z());
      sum += row.force.z();
      if (row.position.z() < 1e-9) carried += row.force.z();
    }
    const double weight = density * g * std::numbers::pi * 0.015 * 0.015 * height;
    const double expected = -density * g * height * height / (2 * young);
    EXPECT_NEAR(sag / expected, 1, element == std::string("p1") ? 0.02 : 0.05) << element;
    EXPECT_GT(carried, 0.85 * weight) << element;
    EXPECT_LT(carried, weight) << element;
    EXPECT_LT(std::abs(sum), 1e-9 * weight) << element;
  }
  testing::expect_refusal(fmt::format("{} solve {} --gravity 0 0 -9.81", program("palpate"), file.string()),
                          {"--gravity", "--method direct"});
}

TEST_F(ToolsSolve, WhatIsNoNumberIsNoSolution) {
  const int node = nearest_node(plate_mesh(), {0.015, 0.01, 0.008});
  for (const char* method : {"direct", "tensors"})
    testing::expect_refusal(fmt::format("{} solve {} --method {} --force {}:1e308,1e308,1e308", program("palpate"),
                                        plate().string(), method, node),
                            {"it is not finite"});
  testing::expect_refusal(fmt::format("{} solve {} --hold {}:0,0,1e200", program("palpate"), plate().string(), node),
                          {"--hold", "1e+200 m is more than 1000 m"});
}

// The measured curves of the specimen hold: at a press of 1 mm the force is not the linear one, what is held stays, and
// the rest moves by another share across the press; by both methods alike.
TEST_F(ToolsSolve, TheQuasiNonLinearCorrectionOfTheSceneIsApplied) {
  const fs::path scene = linear_elements("brain_cylinder"), linear = folder_ / "linear.toml";
  std::string text = testing::text_of(scene);
  const auto begin = text.find("[body.nonlinear]"), end = text.find("\n[", begin);
  ASSERT_LT(begin, end);
  text.erase(begin, end - begin);
  std::ofstream(linear) << text;
  const TetMesh mesh = load_tet_mesh(fs::path(PALPATE_SOURCE) / "scenes/meshes/cylinder.msh", 1);
  Vector3d top = mesh.nodes[0];
  for (const Vector3d& node : mesh.nodes)
    if (node.z() > top.z()) top = node;
  const int node = nearest_node(mesh, {0, 0, top.z()});
  const std::vector<std::string> hold{fmt::format("{}:0,0,-0.001", node)};
  expect_agreement(scene, hold);
  const Table corrected = solve(scene, "tensors", hold), plain = solve(linear, "tensors", hold);
  const Row &c = corrected.at(node), &p = plain.at(node);
  EXPECT_EQ(c.displacement, p.displacement);
  const double scale = c.force.norm() / p.force.norm();
  EXPECT_GT(std::abs(scale - 1), 0.01);
  EXPECT_LT((c.force - scale * p.force).norm(), 1e-9 * c.force.norm());
  const Vector3d press = p.force.normalized();
  double largest = 0;
  for (const auto& [number, row] : plain) {
    const Vector3d change = corrected.at(number).displacement - row.displacement;
    EXPECT_LT(std::abs(change.dot(press)), 1e-12) << number;
    largest = std::max(largest, change.norm());
  }
  EXPECT_GT(largest, 1e-7);
}

TEST_F(ToolsSolve, TensorsEqualDirectOnTheRealLiver) {
  const fs::path file = fs::path(PALPATE_SOURCE).parent_path() / "shared/data/liver.msh";
  if (!fs::exists(file)) GTEST_SKIP() << "the real liver is not at " << file;
  constexpr double scale = 0.03;
  const TetMesh mesh = load_tet_mesh(file, scale);
  Eigen::AlignedBox3d extent;
  for (const Vector3d& node : mesh.nodes) extent.extend(node);
  const Vector3d low = extent.min(), size = extent.sizes();
  std::ofstream(folder_ / "liver.toml") << fmt::format(R"(title = "the real liver"
[[body]]
name = "liver"
mesh = "{}"
scale = {}
young = 5000.0
poisson = 0.45
[[body.fixed]]
box = [[-9.0, -9.0, -9.0], [9.0, {}, 9.0]]
[[tool]]
name = "probe"
pivot = [0.0, 0.0, 1.0]
radius = 0.005
device = "bus"
)",
                                                       file.string(), scale, low.y() + 0.2 * size.y());
  const auto hold = [&](const Vector3d& direction, const std::string& displacement) {
    const Vector3d point = extent.center() + direction.cwiseProduct(size);
    return fmt::format("{}:{}", nearest_node(mesh, point), displacement);
  };
  expect_agreement(folder_ / "liver.toml", {hold({0, 1, 0}, "0,-0.005,0"), hold({-1, 0.3, 0}, "0.003,0,0.001"),
                                            hold({0.5, 0.5, 1}, "0,0,-0.004")});
}

}  // namespace
}  // namespace palpate

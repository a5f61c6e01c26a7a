#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numeric>

#include "common/models/moving/precompute.hpp"
#include "common/models/tensor_mass/spec.hpp"
#include "tests/dynamics/hybrid_bodies.hpp"

/// The steady state of hybrid bodies in motion.
namespace palpate {
namespace {

using Eigen::Vector3d;
using namespace testing;

const Vector3d kRestGravity(1.5, -0.7, -9.81);
constexpr double kRestDamping = 80;  // [1/s], about critical for the lowest frequency of the blocks here
constexpr double kRestTime = 0.8;    // [s] from the start to rest

/// Point loads [N] spread over touchable nodes of the chosen parts.
template <class Run>
std::vector<Vector3d> put_point_loads(Run& run, bool on_quasi_static, bool on_dynamic, std::size_t mesh_nodes) {
  std::vector<Vector3d> load(mesh_nodes, Vector3d::Zero());
  for (int i = 0; i < run.archive.surface.touchable; i += 5) {
    const bool owned = run.part.owns(i);
    if (owned ? !on_quasi_static : !on_dynamic) continue;
    const Vector3d force = 1e-3 * Vector3d(std::sin(i), std::cos(2.0 * i), -1);
    load[run.archive.surface.node_number[i]] += force;
    if (owned)
      run.part.set_force(i, force);
    else
      run.model.set_load(i, run.model.load(i) + force);
  }
  run.part.hold();
  run.part.add_loads(run.model);
  return load;
}

struct Case {
  Vector3d gravity;
  bool on_quasi_static, on_dynamic;
};

template <class Scalar>
double worst_difference(const Case& loads) {
  const auto mesh = make_hybrid_block({4, 3, 4}, 0.01);
  double worst = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto body = hybrid_body(random_part(mesh, seed), loads.gravity);
    const auto problem = make_static_problem(body, mesh);
    HybridRun<Scalar> run(precompute(body, mesh), 0, kRestDamping, loads.gravity);
    auto load = put_point_loads(run, loads.on_quasi_static, loads.on_dynamic, mesh.nodes.size());
    const auto weight = weights(problem, loads.gravity);
    for (std::size_t i = 0; i < load.size(); ++i) load[i] += weight[i];
    run.run(kRestTime);
    worst = std::max(worst, static_difference(run, solve_loads(problem, load)));
  }
  std::printf("largest difference from the direct solve: %.3g\n", worst);
  return worst;
}

const Case kCases[] = {{kRestGravity, false, false},
                       {Vector3d::Zero(), true, false},
                       {Vector3d::Zero(), false, true},
                       {kRestGravity, true, true}};

TEST(HybridRest, IsTheQuasiStaticStateForEveryBorderAndLoadInDouble) {
  for (const Case& one : kCases) EXPECT_LT(worst_difference<double>(one), 1e-6);
}

TEST(HybridRest, IsTheQuasiStaticStateForEveryBorderAndLoadInSingle) {
  for (const Case& one : kCases) EXPECT_LT(worst_difference<float>(one), 1e-3);
}

/// The same loads on a body that is all tensor-mass.
template <class Scalar>
double difference_from_tensor_mass() {
  const auto mesh = make_hybrid_block({4, 3, 4}, 0.01);
  const auto whole = precompute_moving(hybrid_body({}, kRestGravity), TensorMassSpec::kKind, mesh);
  TensorMass<Scalar> model(elastic_mesh(whole), Integrator::rk4, kRestDamping);
  model.set_gravity(kRestGravity);
  const double dt = 0.9 * max_step(Integrator::rk4, model.frequency_bound(), 0);
  for (int i = 0; i < kRestTime / dt; ++i) model.step(dt);
  std::vector<Vector3d> of_node(mesh.nodes.size(), Vector3d::Zero());
  for (int i = 0; i < whole.surface.size(); ++i) of_node[whole.surface.node_number[i]] = model.displacement(i);
  double worst = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    HybridRun<Scalar> run(precompute(hybrid_body(random_part(mesh, seed), kRestGravity), mesh), 0, kRestDamping,
                          kRestGravity);
    run.run(kRestTime);
    worst = std::max(worst, static_difference(run, {of_node, {}}));
  }
  std::printf("largest difference from the tensor-mass body: %.3g\n", worst);
  return worst;
}

TEST(HybridRest, IsThatOfTheTensorMassBody) {
  EXPECT_LT(difference_from_tensor_mass<double>(), 1e-6);
  EXPECT_LT(difference_from_tensor_mass<float>(), 1e-3);
}

/// Reactions that lag by a step would feed in energy; so would a bound that does not cover the connection
/// nodes.
TEST(HybridMotion, KeepsOrLosesEnergyAtTheLargestStepWhereverTheBorderIs) {
  const auto mesh = make_hybrid_block({4, 3, 4}, 0.01);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    HybridRun<double> run(precompute(hybrid_body(random_part(mesh, seed)), mesh), 0, 0, Vector3d::Zero());
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-0.1, 0.1);
    for (int node = 0; node < run.model.nodes(); ++node)
      if (run.model.mass(node) > 0)
        run.model.set_motion(node, Vector3d::Zero(), {uniform(random), uniform(random), uniform(random)});
    const double dt = 0.999 * max_step(Integrator::rk4, run.model.frequency_bound(), 0);
    const auto connection = run.part.connection();
    std::vector<double> u(3 * connection.size()), force(u.size());
    const auto energy = [&] {
      for (std::size_t k = 0; k < connection.size(); ++k)
        Eigen::Map<Vector3d>(u.data() + 3 * k) = run.model.displacement(connection[k]);
      std::fill(force.begin(), force.end(), 0.0);
      run.part.apply(u.data(), force.data());
      return run.model.energy() - 0.5 * std::inner_product(u.begin(), u.end(), force.begin(), 0.0);
    };
    const double first = energy();
    double largest = 0;
    for (int i = 0; i < 3000; ++i) {
      run.model.step(dt);
      if (i % 50 == 0) largest = std::max(largest, energy());
    }
    EXPECT_LE(largest, first * (1 + 1e-9)) << "border " << seed;
    EXPECT_GT(energy(), 0.001 * first) << "border " << seed;
  }
}

TEST(HybridRest, SurfaceForThePictureIsThatOfTheNodes) {
  const auto mesh = make_hybrid_block({4, 3, 4}, 0.01);
  HybridRun<double> run(precompute(hybrid_body(random_part(mesh, 7), kRestGravity), mesh), 0, kRestDamping,
                        kRestGravity);
  put_point_loads(run, true, false, mesh.nodes.size());
  run.run(0.01);
  std::vector<Eigen::Vector3f> picture(run.archive.surface.size(), Eigen::Vector3f::Constant(7));
  run.part.superpose(picture);
  std::vector<Vector3d> shown, exact;
  for (int i = 0; i < run.archive.surface.size(); ++i) {
    const bool ours = run.part.owns(i) || std::ranges::find(run.part.connection(), i) != run.part.connection().end();
    if (!ours) {
      EXPECT_EQ(picture[i], Eigen::Vector3f::Constant(7));
      continue;
    }
    shown.push_back(picture[i].cast<double>());
    exact.push_back(run.displacement(i));
  }
  EXPECT_LT(relative_difference(shown, exact), 1e-5);
}

/// Connection nodes belong to both parts, so that displacements cannot jump; normals could.
TEST(HybridRest, NormalsAcrossTheBorderAreThoseOfOneBody) {
  const auto mesh = make_hybrid_block({5, 4, 5}, 0.01);
  for (unsigned seed : {1u, 2u, 3u, 4u}) {
    const auto body = hybrid_body(random_part(mesh, seed), kRestGravity);
    const auto problem = make_static_problem(body, mesh);
    HybridRun<float> run(precompute(body, mesh), 0, kRestDamping, kRestGravity);
    run.run(kRestTime);
    const auto direct = solve_loads(problem, weights(problem, kRestGravity));
    const SurfaceMap& map = run.archive.surface;
    std::vector<Vector3d> ours, theirs;
    for (int i = 0; i < map.size(); ++i) {
      ours.push_back(map.position[i] + run.displacement(i));
      theirs.push_back(map.position[i] + direct.displacement[map.node_number[i]]);
    }
    const auto normal = [&](const std::vector<Vector3d>& x, const std::array<int, 3>& t) {
      return Vector3d((x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).normalized());
    };
    int border = 0;
    double worst = 0;
    for (const auto& t : map.triangles) {
      for (int v : t) border += std::ranges::find(run.part.connection(), v) != run.part.connection().end();
      worst = std::max(worst, (normal(ours, t) - normal(theirs, t)).norm());
    }
    EXPECT_GT(border, 10);
    EXPECT_LT(worst, 1e-3);
  }
}

}  // namespace
}  // namespace palpate

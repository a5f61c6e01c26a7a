#include <gtest/gtest.h>

#include "common/geometry/dense_solvers.hpp"
#include "tests/dynamics/hybrid_bodies.hpp"
#include "tests/tool/count_allocations.hpp"

/// Tools on the quasi-static part of a hybrid body.
namespace palpate {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using namespace testing;

constexpr double kDamping = 80;  // [1/s]
constexpr double kTime = 0.8;    // [s]
const Vector3d kGravity(0, 0, -9.81);

enum class Where { quasi_static, border };

/// Triangles of the top whose nodes all belong to the quasi-static part, or that lie across the border.
std::vector<std::array<int, 3>> top_triangles(const CondensedPart& part, const SurfaceMap& map, Where where) {
  std::vector<std::array<int, 3>> found;
  const double top = std::ranges::max(map.position, {}, [](const Vector3d& x) { return x.z(); }).z();
  for (const auto& t : map.triangles) {
    int own = 0, high = 0, connected = 0;
    for (int node : t) {
      own += part.owns(node);
      high += map.position[node].z() > top - 1e-9;
      connected += std::ranges::find(part.connection(), node) != part.connection().end();
    }
    if (high == 3 && (where == Where::border ? own > 0 && own < 3 && own + connected == 3 : own == 3))
      found.push_back(t);
  }
  return found;
}

TouchContact press(const std::array<int, 3>& triangle, const SurfaceMap& map, const Vector3d& motion) {
  TouchContact contact;
  contact.face = true;
  contact.touch = Touch::sticking;
  contact.anchor = {triangle, {0.5, 0.3, 0.2}};
  contact.normal = -Vector3d::UnitZ();
  contact.target = anchor_position(contact.anchor, map.position) + motion;
  contact.plane = contact.normal.dot(contact.target);
  return contact;
}

/// Mesh with a quasi-static half that reaches the top, cut off by a slanted plane.
std::vector<int> slanted_part(const TetMesh& mesh) {
  std::vector<int> part;
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
    Vector3d at = Vector3d::Zero();
    for (int node : mesh.tetrahedra[e]) at += mesh.nodes[node] / 4;
    if (at.x() + 0.3 * at.z() > 0.028) part.push_back(e);
  }
  return part;
}

struct Pressed {
  double displacement, force;  ///< largest differences from the direct solve, relative to the largest value
};

/// Holds points of the quasi-static part, loads nodes of both, and compares with one static solve of the
/// whole mesh.
template <class Scalar>
Pressed press_and_compare(int contacts, Touch touch) {
  const auto mesh = make_hybrid_block({5, 4, 4}, 0.01);
  const auto body = hybrid_body(slanted_part(mesh), kGravity);
  const auto problem = make_static_problem(body, mesh);
  HybridRun<Scalar> run(precompute(body, mesh), touch == Touch::sliding ? 0 : 10, kDamping, kGravity);
  const SurfaceMap& map = run.archive.surface;
  const auto triangles = top_triangles(run.part, map, Where::quasi_static);
  std::vector<Constraint> constraints;
  auto load = weights(problem, kGravity);
  for (int i = 0; i < contacts; ++i) {
    auto contact = press(triangles.at(triangles.size() * i / contacts), map, Vector3d(1e-4, -1e-4, -2e-3));
    contact.touch = touch;
    run.part.law().add(contact);
    const Vector3d motion = contact.target - anchor_position(contact.anchor, map.position);
    for (int axis = touch == Touch::sliding ? 2 : 0; axis < 3; ++axis) {
      constraints.push_back({{}, motion[axis]});
      for (int v = 0; v < 3; ++v)
        constraints.back().terms.push_back({map.node_number[contact.anchor.nodes[v]], axis, contact.anchor.weights[v]});
    }
  }
  for (int i = 0; i < map.touchable; i += 7) {  // on both parts
    const Vector3d force(1e-3 * std::sin(i), 1e-3, -5e-4);
    load[map.node_number[i]] += force;
    if (run.part.owns(i))
      run.part.set_force(i, force);
    else
      run.model.set_load(i, run.model.load(i) + force);
  }
  const double dt = run.step_size();
  for (double time = 0; time < kTime; time += 16 * dt) {  // a round of the owner's loop
    run.part.take(run.model);
    run.part.hold();
    run.part.add_loads(run.model);
    for (int i = 0; i < 16; ++i) run.model.step(dt);
  }
  run.part.take(run.model);

  for (const TouchContact& contact : run.part.law().contacts()) EXPECT_EQ(contact.touch, touch);
  const auto loaded = solve_loads(problem, load);
  for (Constraint& c : constraints)
    for (const auto& term : c.terms) c.value -= term.weight * loaded.displacement[term.node][term.axis];
  auto direct = solve_direct(problem, constraints);
  Vector3d total = Vector3d::Zero(), ours = Vector3d::Zero();
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    if (mesh.nodes[n].z() > 0.039) total += direct.force[n];  // the held points are on the top
    direct.displacement[n] += loaded.displacement[n];
  }
  for (int i = 0; i < contacts; ++i) ours += run.part.contact_force(i);
  EXPECT_LT(total.z(), 0);
  return {static_difference(run, direct), (ours - total).norm() / total.norm()};
}

TEST(HybridContact, HeldPointsRestWhereOneBodyWouldInDouble) {
  for (const Touch touch : {Touch::sticking, Touch::sliding})
    for (int contacts : {1, 2, 4}) {
      const auto difference = press_and_compare<double>(contacts, touch);
      EXPECT_LT(difference.displacement, 1e-6) << contacts;
      EXPECT_LT(difference.force, 1e-6) << contacts;
    }
}

TEST(HybridContact, HeldPointsRestWhereOneBodyWouldInSingle) {
  for (const Touch touch : {Touch::sticking, Touch::sliding}) {
    const auto difference = press_and_compare<float>(4, touch);
    EXPECT_LT(difference.displacement, 1e-3);
    EXPECT_LT(difference.force, 1e-3);
  }
}

/// The largest squared frequency with contacts of every kind, from apply() and the tensors, against the
/// bound.
TEST(HybridContact, FrequencyBoundCoversContactsAnywhere) {
  const auto mesh = make_hybrid_block({5, 4, 4}, 0.01);
  double tightest = 0;
  for (const Where where : {Where::quasi_static, Where::border}) {
    HybridRun<double> run(precompute(hybrid_body(slanted_part(mesh)), mesh), 10, 0, Vector3d::Zero());
    const SurfaceMap& map = run.archive.surface;
    const auto triangles = top_triangles(run.part, map, where);
    ASSERT_GT(triangles.size(), 3u);
    for (const auto& triangle : triangles)
      if (!run.part.law().full()) {
        auto contact = press(triangle, map, {0, 0, -1e-3});
        if (where == Where::border) {  // nearly all its weight on one connection node
          const int at = static_cast<int>(std::ranges::find_if(triangle, [&](int n) { return !run.part.owns(n); }) -
                                          triangle.begin());
          contact.anchor.weights.setConstant(0.01);
          contact.anchor.weights[at] = 0.98;
          contact.target = anchor_position(contact.anchor, map.position) - Vector3d(0, 0, 1e-3);
        }
        run.part.law().add(contact);
      }
    run.part.hold();
    int held = 0;
    for (const TouchContact& contact : run.part.law().contacts()) held += contact.touch != Touch::open;
    EXPECT_GT(held, 2);

    const int nodes = run.model.nodes();
    MatrixXd stiffness = MatrixXd::Zero(3 * nodes, 3 * nodes);
    for (int i = 0; i < nodes; ++i)
      for (int j = 0; j < nodes; ++j)
        stiffness.block<3, 3>(3 * i, 3 * j) = i == j ? run.model.vertex_tensor(i) : run.model.edge_tensor(i, j);
    const auto connection = run.part.connection();
    const auto size = static_cast<Eigen::Index>(3 * connection.size());
    for (Eigen::Index c = 0; c < size; ++c) {
      const VectorXd unit = VectorXd::Unit(size, c);
      VectorXd force = VectorXd::Zero(size);
      run.part.apply(unit.data(), force.data());
      for (Eigen::Index r = 0; r < size; ++r)
        stiffness(3 * connection[r / 3] + r % 3, 3 * connection[c / 3] + c % 3) -= force[r];
    }
    VectorXd scale(3 * nodes);
    for (int i = 0; i < 3 * nodes; ++i) {
      const bool moves = run.model.mass(i / 3) > 0 && !map.fixed[i / 3][i % 3];
      scale[i] = moves ? 1 / std::sqrt(run.model.mass(i / 3)) : 0;
    }
    const MatrixXd scaled = scale.asDiagonal() * stiffness * scale.asDiagonal();
    EXPECT_LT((scaled - scaled.transpose()).norm(), 1e-10 * scaled.norm());
    const double largest = symmetric_eigenvalues(scaled).maxCoeff();
    const double bound = run.model.frequency_bound() * run.model.frequency_bound();
    EXPECT_LE(largest, bound);
    tightest = std::max(tightest, largest / bound);
  }
  std::printf("largest squared frequency over its bound, with contacts: %.3f\n", tightest);
}

/// Contacts across the border yield by no more than the connection nodes' own stiffness allows.
TEST(HybridContact, PointsOnTheBorderFollowTheTool) {
  const auto mesh = make_hybrid_block({5, 4, 4}, 0.01);
  HybridRun<double> run(precompute(hybrid_body(slanted_part(mesh)), mesh), 10, kDamping, Vector3d::Zero());
  const SurfaceMap& map = run.archive.surface;
  const auto triangle = top_triangles(run.part, map, Where::border).at(0);
  const auto contact = press(triangle, map, {0, 0, -1e-3});
  run.part.law().add(contact);
  const double dt = run.step_size();
  for (double time = 0; time < kTime; time += 16 * dt) {
    run.part.take(run.model);
    run.part.hold();
    run.part.add_loads(run.model);
    for (int i = 0; i < 16; ++i) run.model.step(dt);
  }
  run.part.take(run.model);
  Vector3d reached = Vector3d::Zero();
  for (int v = 0; v < 3; ++v) reached += contact.anchor.weights[v] * run.displacement(triangle[v]);
  std::printf("of 1 mm the border follows %.3f mm\n", -1e3 * reached.z());
  EXPECT_NEAR(reached.z(), -1e-3, 2e-4);
  EXPECT_LT(run.part.contact_force(0).z(), 0);
}

TEST(HybridContact, ContactThatWouldPullLetsGo) {
  const auto mesh = make_hybrid_block({5, 4, 4}, 0.01);
  HybridRun<double> run(precompute(hybrid_body(slanted_part(mesh)), mesh), 0.3, kDamping, Vector3d::Zero());
  const SurfaceMap& map = run.archive.surface;
  const auto triangle = top_triangles(run.part, map, Where::quasi_static).at(0);
  run.part.law().add(press(triangle, map, {0, 0, 1e-3}));
  run.part.hold();
  EXPECT_EQ(run.part.law().contacts()[0].touch, Touch::open);
  EXPECT_EQ(run.part.contact_force(0), Vector3d::Zero());
  for (std::size_t k = 0; k < run.part.connection().size(); ++k)
    EXPECT_EQ(run.part.load(static_cast<int>(k)), Vector3d::Zero());
}

TEST(HybridContact, RoundOfTheLoopAllocatesNothing) {
  const auto mesh = make_hybrid_block({5, 4, 4}, 0.01);
  HybridRun<float> run(precompute(hybrid_body(slanted_part(mesh), kGravity), mesh), 0.3, kDamping, kGravity);
  const SurfaceMap& map = run.archive.surface;
  const auto triangles = top_triangles(run.part, map, Where::quasi_static);
  std::vector<Eigen::Vector3f> picture(map.size());
  std::vector<int> near;
  for (int i = 0; i < map.size(); ++i)
    if (run.part.owns(i)) near.push_back(i);
  const double dt = run.step_size();
  const auto round = [&] {
    run.part.take(run.model);
    run.part.update(near);
    run.part.law().clear();
    for (const auto& triangle : triangles)
      if (!run.part.law().full()) run.part.law().add(press(triangle, map, {0, 0, -1e-3}));
    run.part.set_force(near[0], {0, 0, 1e-3});
    run.part.hold();
    run.part.add_loads(run.model);
    run.model.step(dt);
    run.part.superpose(picture);
  };
  const long before = allocations();
  for (int i = 0; i < 10; ++i) round();
  EXPECT_EQ(allocations(), before);
  EXPECT_GT(run.part.law().contacts().size(), 3u);
}

TEST(HybridContact, StiffnessOfANodeIsTheForceForItsDisplacement) {
  const auto mesh = make_hybrid_block({5, 4, 4}, 0.01);
  HybridRun<double> run(precompute(hybrid_body(slanted_part(mesh)), mesh), 0, kDamping, Vector3d::Zero());
  const SurfaceMap& map = run.archive.surface;
  const int node = top_triangles(run.part, map, Where::quasi_static).at(2)[0];
  const Vector3d motion(2e-4, -1e-4, -5e-4);
  run.part.set_force(node, run.part.stiffness(node) * motion);
  run.part.hold();
  EXPECT_LT((run.part.displacement(node) - motion).norm(), 1e-9 * motion.norm());
  EXPECT_THROW(run.part.set_force(run.part.connection()[0], motion), std::runtime_error);
}

// A force goes through the part itself, and draws the connection nodes along, which take the part with them.
TEST(HybridContact, ANodeGivesWayUnderAnotherByThePartAndByTheConnectionNodes) {
  const auto mesh = make_hybrid_block({4, 3, 4}, 0.01);
  const auto archive = precompute(hybrid_body(random_part(mesh, 5)), mesh);
  CondensedPart part(archive, 0, false);
  part.expect_patches(1);
  VectorXd inertia(3 * static_cast<Eigen::Index>(part.connection().size())), drawn(inertia.size());
  for (Eigen::Index k = 0; k < inertia.size(); ++k) inertia[k] = 1e-3 * (1 + 0.1 * static_cast<double>(k % 7));
  std::vector<int> nodes(part.connection().begin(), part.connection().begin() + 3);
  for (int node = 0; node < archive.surface.size() && nodes.size() < 7; ++node)
    if (part.owns(node) && part.stiffness(node).norm() > 0) nodes.push_back(node);
  const Vector3d force(0.3, -0.2, 0.5);
  int across = 0;
  for (const int under : nodes) {
    const std::array one{PatchForce{under, force}};
    part.push(0, one);
    part.draw(0, {drawn.data(), static_cast<std::size_t>(drawn.size())});
    const VectorXd along = inertia.cwiseProduct(drawn);
    for (const int node : nodes) {
      Vector3d moved = part.compliance(node, under) * force;
      const auto at = std::ranges::find(part.connection(), node) - part.connection().begin();
      for (int axis = 0; axis < 3; ++axis) {
        if (!part.owns(node)) {
          moved[axis] += along[3 * at + axis];
          continue;
        }
        const auto follow = part.follow(node, axis);
        moved[axis] += Eigen::Map<const VectorXd>(follow.data(), along.size()).dot(along);
      }
      const Eigen::Matrix3d give = part.give(node, under, {inertia.data(), static_cast<std::size_t>(inertia.size())});
      EXPECT_LE((give * force - moved).norm(), 1e-9 * moved.norm()) << node << " under " << under;
      across += part.owns(node) != part.owns(under) && moved.norm() > 1e-3 * inertia[0] * force.norm();
    }
  }
  EXPECT_GT(across, 4) << "pairs of a node of the part and a connection node";
}

}  // namespace
}  // namespace palpate

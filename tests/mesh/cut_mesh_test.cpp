#include "common/mesh/cut_mesh.hpp"

#include <gtest/gtest.h>

#include "tests/mesh/cut_cases.hpp"
#include "tests/mesh/mesh_test_helpers.hpp"
#include "tests/tool/count_allocations.hpp"

namespace palpate {
namespace {

using Edge = std::array<int, 2>;

// A set of things in pairs hangs together, or is empty.
template <class Thing>
bool hangs_together(const std::map<Thing, std::vector<Thing>>& beside) {
  if (beside.empty()) return true;
  std::set<Thing> reached{beside.begin()->first};
  std::vector<Thing> waiting(reached.begin(), reached.end());
  while (!waiting.empty()) {
    const Thing thing = waiting.back();
    waiting.pop_back();
    for (const Thing& next : beside.at(thing))
      if (reached.insert(next).second) waiting.push_back(next);
  }
  return reached.size() == beside.size();
}

// Tetrahedra of one node, next to each other where they share a face with the node.
bool star_hangs_together(const TetMesh& mesh, int node, const std::vector<int>& star) {
  std::map<std::set<int>, std::vector<int>> of_face;
  for (int t : star)
    for (int skip : mesh.tetrahedra[t]) {
      if (skip == node) continue;
      std::set<int> face(mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end());
      face.erase(skip);
      of_face[face].push_back(t);
    }
  std::map<int, std::vector<int>> beside;
  for (int t : star) beside[t];
  for (const auto& [face, owners] : of_face)
    for (int a : owners)
      for (int b : owners)
        if (a != b) beside[a].push_back(b);
  return hangs_together(beside);
}

/// What is wrong with a mesh, from its tetrahedra alone; empty if it is manifold.
std::string fault_of(const TetMesh& mesh) {
  std::map<int, std::vector<int>> stars;
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t)
    for (int n : mesh.tetrahedra[t]) stars[n].push_back(t);
  for (const auto& [node, star] : stars)
    if (!star_hangs_together(mesh, node, star)) return "parts meet only in node or edges at " + std::to_string(node);

  std::map<Edge, int> uses;                             // directed edges of the surface
  std::map<int, std::map<int, std::vector<int>>> ring;  // around each node: which follows which
  for (const auto& t : extract_surface(mesh).triangles)
    for (int c = 0; c < 3; ++c) {
      const int a = t[c], b = t[(c + 1) % 3], d = t[(c + 2) % 3];
      if (++uses[{a, b}] > 1) return "a surface edge with several facets at " + std::to_string(a);
      ring[a][b].push_back(d);
      ring[a][d];
    }
  for (const auto& [edge, count] : uses)
    if (!uses.contains({edge[1], edge[0]})) return "an open surface at " + std::to_string(edge[0]);
  for (const auto& [node, beside] : ring)
    if (!hangs_together(beside)) return "several fans at node " + std::to_string(node);
  return "";
}

std::set<std::array<int, 3>> visible_of(const CutMesh& cut) {
  std::set<std::array<int, 3>> facets;
  for (int id : cut.visible()) {
    std::array<int, 3> f = cut.facet(id);
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
    EXPECT_TRUE(cut.alive(id / 4) && cut.is_visible(id));
    EXPECT_TRUE(facets.insert(f).second) << "a facet twice";
  }
  return facets;
}

std::set<std::array<int, 3>> extracted(const TetMesh& mesh) {
  std::set<std::array<int, 3>> facets;
  for (std::array<int, 3> f : extract_surface(mesh).triangles) {
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
    facets.insert(f);
  }
  return facets;
}

CutMesh cut_mesh(const TetMesh& mesh) {
  return CutMesh(mesh.tetrahedra, static_cast<int>(mesh.nodes.size()));
}

TEST(ManifoldCheckOfTheseTests, FindsEachKindOfFault) {
  const std::vector<Eigen::Vector3d> nodes(8);
  EXPECT_EQ(fault_of({nodes, {{0, 1, 2, 3}}, {}}), "");
  EXPECT_EQ(fault_of({nodes, {{0, 1, 2, 3}, {0, 2, 1, 4}}, {}}), "");
  EXPECT_NE(fault_of({nodes, {{0, 1, 2, 3}, {0, 4, 5, 6}}, {}}), "") << "joined by a node";
  EXPECT_NE(fault_of({nodes, {{0, 1, 2, 3}, {0, 1, 4, 5}}, {}}), "") << "joined by an edge";
  // A tunnel through one node: around it a ring of tetrahedra.
  TetMesh tunnel = make_block({-1, -1, -1}, {1, 1, 1}, {2, 2, 2});
  std::erase_if(tunnel.tetrahedra, [&](const auto& t) {
    double z = 0;
    for (int n : t) z += tunnel.nodes[n].z() * (tunnel.nodes[n].head<2>().isZero() ? 4 : 1);
    return std::abs(z) > 5;
  });
  EXPECT_NE(fault_of(tunnel), "");
}

// After every removal: the surface is the extracted one, the mesh manifold, the counts right.
TEST(CutMesh, StaysManifoldWithTheRightSurfaceThroughTenThousandRemovals) {
  std::mt19937 random(1);
  int removals = 0;
  long gone = 0;
  for (unsigned round = 0; removals < 10000; ++round) {
    const TetMesh mesh = cut_case(round, random);
    CutMesh cut = cut_mesh(mesh);
    Cutter cutter(mesh, round / 5);
    std::vector<int> removed;
    for (; cut.alive_count() > 0 && removals < 10000; ++removals) {
      const int aim = cutter.aim(cut);
      const std::size_t before = removed.size();
      cut.remove(aim, removed);
      ASSERT_EQ(removed[before], aim);
      ASSERT_EQ(removed.size() + cut.alive_count(), mesh.tetrahedra.size());
      for (std::size_t i = before; i < removed.size(); ++i) ASSERT_FALSE(cut.alive(removed[i]));
      if (mesh.tetrahedra.size() > 300 && removals % 4 != 0 && cut.alive_count() > 50) continue;
      const TetMesh left = living(cut);
      ASSERT_EQ(visible_of(cut), extracted(left)) << "round " << round << ", removal " << removals;
      ASSERT_EQ(fault_of(left), "") << "round " << round << ", removal " << removals;
    }
    gone += static_cast<long>(removed.size());
  }
  EXPECT_LT(5 * gone, 9 * removals) << "far more goes than is aimed at";
  RecordProperty("removed_per_removal_in_percent", static_cast<int>(100 * gone / removals));
}

TEST(CutMesh, RemovesATetrahedronAloneWhereThatIsEnough) {
  const TetMesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {4, 4, 4});
  CutMesh cut = cut_mesh(mesh);
  std::vector<int> removed;
  for (int t = 0; t < cut.size(); ++t) {  // amid the tissue: a closed hollow
    bool inside = true;
    for (int n : cut.tetrahedron(t)) inside &= (mesh.nodes[n].array() > 0).all() && (mesh.nodes[n].array() < 1).all();
    if (!inside) continue;
    cut.remove(t, removed);
    EXPECT_EQ(removed, std::vector<int>{t});
    EXPECT_EQ(cut.appeared().size(), 4u);
    EXPECT_TRUE(cut.vanished().empty());
    return;
  }
  FAIL();
}

TEST(CutMesh, RemovesTheSmallerOfTwoPartsThatOnlyAnEdgeOrANodeJoins) {
  // A chain: 0 and 1 share a face, 1 and 2 too; 3 hangs at 2. Without 1, tetrahedron 0 would hang at an edge.
  const std::vector<std::array<int, 4>> chain{{0, 1, 2, 3}, {1, 2, 3, 4}, {2, 3, 4, 5}, {3, 4, 5, 6}};
  CutMesh cut(chain, 7);
  std::vector<int> removed;
  cut.remove(1, removed);
  EXPECT_EQ(removed, (std::vector<int>{1, 0}));
  EXPECT_FALSE(cut.has_node(0));
  EXPECT_FALSE(cut.has_node(1));
  EXPECT_TRUE(cut.has_node(2));
  EXPECT_EQ(cut.visible().size(), 6u);
}

TEST(CutMesh, OpensATunnelThroughANodeToOneSide) {
  // Around the middle node of a block two opposite tetrahedra: their removal would leave a ring.
  const TetMesh mesh = make_block({-1, -1, -1}, {1, 1, 1}, {2, 2, 2});
  int middle = 0;
  for (int n = 0; n < 27; ++n)
    if (mesh.nodes[n].isZero()) middle = n;
  CutMesh cut = cut_mesh(mesh);
  const auto on = [&](int t, double sign) {  // those at the middle whose other corners all lie on one side
    double z = 0;
    for (int n : mesh.tetrahedra[t]) z += sign * mesh.nodes[n].dot(Eigen::Vector3d(1, 1, 1));
    return z >= 5.9;
  };
  std::vector<int> removed;
  for (double sign : {1.0, -1.0})
    for (int t : cut.around_node(middle))
      if (cut.alive(t) && on(t, sign)) {
        cut.remove(t, removed);
        break;
      }
  EXPECT_GT(removed.size(), 2u);
  EXPECT_LT(removed.size(), 12u);
  EXPECT_TRUE(cut.has_node(middle));
  EXPECT_EQ(fault_of(living(cut)), "");
}

TEST(CutMesh, TellsExactlyWhatAppearedAndVanished) {
  std::mt19937 random(2);
  const TetMesh mesh = cut_case(2, random);
  CutMesh cut = cut_mesh(mesh);
  EXPECT_TRUE(cut.appeared().empty());
  Cutter cutter(mesh, 0);
  std::set<int> followed(cut.visible().begin(), cut.visible().end());
  std::vector<int> removed;
  while (cut.alive_count() > 0) {
    cut.remove(cutter.aim(cut), removed);
    for (int id : cut.vanished()) ASSERT_EQ(followed.erase(id), 1u);
    for (int id : cut.appeared()) ASSERT_TRUE(followed.insert(id).second);
    ASSERT_EQ(followed, std::set<int>(cut.visible().begin(), cut.visible().end()));
  }
}

TEST(CutMesh, ErasingTheListOfRemovedOnesGivesTheSameMesh) {
  std::mt19937 random(3);
  for (unsigned round = 0; round < 12; ++round) {
    const TetMesh mesh = cut_case(round, random);
    CutMesh cut = cut_mesh(mesh), step_by_step = cut_mesh(mesh);
    Cutter cutter(mesh, round);
    std::vector<int> removed;
    while (2 * cut.alive_count() > cut.size()) {
      const std::size_t before = removed.size();
      cut.remove(cutter.aim(cut), removed);
      step_by_step.erase(std::span(removed).subspan(before));
      ASSERT_TRUE(std::ranges::equal(cut.visible(), step_by_step.visible())) << "the order of facets differs";
      ASSERT_TRUE(std::ranges::equal(cut.appeared(), step_by_step.appeared()));
    }
    CutMesh late = cut_mesh(mesh);
    late.erase(removed);
    late.erase(removed);  // what is dead stays so
    EXPECT_EQ(visible_of(late), visible_of(cut));
    EXPECT_EQ(late.alive_count(), cut.alive_count());
    for (int n = 0; n < cut.nodes(); ++n) ASSERT_EQ(late.has_node(n), cut.has_node(n));
    // And it goes on in the same way.
    std::vector<int> here, there;
    const int aim = cutter.aim(cut);
    cut.remove(aim, here);
    late.remove(aim, there);
    EXPECT_EQ(here, there);
  }
}

TEST(CutMesh, CountsThePartsThatACutLeaves) {
  const TetMesh mesh = make_block({0, 0, 0}, {6, 1, 1}, {6, 2, 2});
  CutMesh cut = cut_mesh(mesh);
  std::vector<int> part, removed;
  EXPECT_EQ(cut.parts(part), 1);
  for (int t = 0; t < cut.size(); ++t) {
    double x = 0;
    for (int n : mesh.tetrahedra[t]) x += 0.25 * mesh.nodes[n].x();
    if (x > 2 && x < 3) cut.remove(t, removed);
  }
  EXPECT_EQ(cut.parts(part), 2);
  for (int t = 0; t < cut.size(); ++t) {
    double x = 0;
    for (int n : mesh.tetrahedra[t]) x += 0.25 * mesh.nodes[n].x();
    ASSERT_EQ(part[t], cut.alive(t) ? x > 2 : -1);
  }
}

TEST(CutMesh, BringsAMeshInOrderThatWasNotManifold) {
  std::mt19937 random(4);
  for (int round = 0; round < 20; ++round) {
    TetMesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {3, 3, 3});
    std::erase_if(mesh.tetrahedra, [&](const auto&) { return random() % 3 == 0; });
    CutMesh cut = cut_mesh(mesh);
    ASSERT_NE(fault_of(living(cut)), "");
    std::vector<int> removed;
    for (int node = 0; node < cut.nodes(); ++node)  // each node is cut at once
      if (cut.has_node(node))
        for (int t : cut.around_node(node))
          if (cut.alive(t)) {
            cut.remove(t, removed);
            break;
          }
    EXPECT_EQ(fault_of(living(cut)), "");
    EXPECT_EQ(visible_of(cut), extracted(living(cut)));
  }
}

TEST(CutMesh, TakesNoMemoryAfterConstruction) {
  std::mt19937 random(5);
  const TetMesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {6, 6, 6});
  CutMesh cut = cut_mesh(mesh);
  std::vector<int> removed;
  removed.reserve(mesh.tetrahedra.size());
  const long before = allocations();
  for (int i = 0; i < 200; ++i) cut.remove(static_cast<int>(random() % cut.size()), removed);
  const std::array<int, 2> last{0, 1};
  cut.erase(last);
  while (cut.alive_count() > 0) cut.remove(cut.visible().front() / 4, removed);
  EXPECT_EQ(allocations() - before, 0);
}

TEST(CutMesh, RefusesFacesOfThreeAndNodesThatDoNotExist) {
  const std::vector<std::array<int, 4>> three{{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}};
  EXPECT_EQ(sentence_of([&] { CutMesh(three, 6); }),
            "tetrahedron 2: its face with the nodes 0, 1 and 2 belongs to two others");
  EXPECT_EQ(sentence_of([&] { CutMesh(three, 4); }), "tetrahedron 1: node 4 does not exist, there are 4");
}

TEST(CutMesh, OfNothingIsEmpty) {
  CutMesh cut({}, 0);
  EXPECT_TRUE(cut.visible().empty());
  std::vector<int> part;
  EXPECT_EQ(cut.parts(part), 0);
}

/// Whether the living tetrahedra that hold all of `nodes` hang together through faces that hold them too.
bool hang_together(const CutMesh& mesh, const std::vector<int>& nodes) {
  const auto holds = [&](std::span<const int> all) {
    return std::ranges::all_of(nodes, [&](int n) { return std::ranges::find(all, n) != all.end(); });
  };
  std::vector<int> star, reached;
  for (int t : mesh.around_node(nodes[0]))
    if (mesh.alive(t) && holds(mesh.tetrahedron(t))) star.push_back(t);
  if (star.empty()) return true;
  reached.push_back(star[0]);
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (int t : star) {
      if (std::ranges::find(reached, t) != reached.end()) continue;
      std::vector<int> shared;
      for (int n : mesh.tetrahedron(t))
        if (std::ranges::find(mesh.tetrahedron(reached[i]), n) != mesh.tetrahedron(reached[i]).end())
          shared.push_back(n);
      if (shared.size() == 3 && holds(shared)) reached.push_back(t);
    }
  return reached.size() == star.size();
}

TEST(CutMesh, HangsOnALargerBodyThroughFacesAlone) {
  const TetMesh block = make_block_of_five({0, 0, 0}, {6, 5, 4}, {6, 5, 4});
  const auto moves = [&](int t) {
    double height = 0;
    for (int n : block.tetrahedra[t]) height += block.nodes[n].z() / 4;
    return height > 2;
  };
  std::vector<std::array<int, 4>> part;
  std::vector<int> number;
  for (int t = 0; t < static_cast<int>(block.tetrahedra.size()); ++t)
    if (moves(t)) part.push_back(block.tetrahedra[t]), number.push_back(t);
  std::mt19937 random(3);
  int removals = 0;
  for (int trial = 0; trial < 6; ++trial) {
    CutMesh whole(block.tetrahedra, static_cast<int>(block.nodes.size())),
        cut(part, static_cast<int>(block.nodes.size()));
    std::vector<int> joints;
    for (int facet : cut.visible())
      if (std::ranges::all_of(cut.facet(facet), [&](int n) { return block.nodes[n].z() == 2; }))
        joints.push_back(facet);
    ASSERT_EQ(joints.size(), 60u);
    cut.join(joints);
    while (cut.alive_count() > 0) {
      std::vector<int> removed, in_whole;
      const int t = std::uniform_int_distribution<int>(0, cut.size() - 1)(random);
      if (!cut.alive(t)) continue;
      cut.remove(t, removed);
      for (int r : removed) in_whole.push_back(number[r]);
      whole.erase(in_whole);
      ++removals;
      for (int n = 0; n < whole.nodes(); ++n) {
        if (block.nodes[n].z() != 2) continue;
        ASSERT_TRUE(hang_together(whole, {n})) << "node " << n << " after " << removals;
      }
      for (int facet : joints)
        for (int v = 0; v < 3; ++v) {
          const auto nodes = cut.facet(facet);
          ASSERT_TRUE(hang_together(whole, {nodes[v], nodes[(v + 1) % 3]})) << "an edge after " << removals;
        }
    }
    EXPECT_EQ(whole.alive_count(), whole.size() - cut.size()) << "the larger body loses nothing";
  }
  EXPECT_GT(removals, 300);
}

}  // namespace
}  // namespace palpate

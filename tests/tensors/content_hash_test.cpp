#include "common/models/content_hash.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "tests/tensors/files_for_tests.hpp"

namespace palpate {
namespace {

class ContentHash : public ::testing::Test {
 protected:
  ContentHash() {
    put("liver.msh", "mesh one");
    put("other.msh", "mesh two");
    body.name = "liver";
    body.mesh = folder / "liver.msh";
    body.material = {1e4, 0.45, 1000};
    BoundaryCondition base;
    base.where.indices = {1, 2, 3};
    body.fixed = {base};
  }
  void put(const std::string& name, const std::string& text) {
    testing::write_bytes(folder / name, {text.begin(), text.end()}, text.size());
  }
  /// Of the body as one of the kind, changed.
  template <class Kind = QuasiStaticSpec>
  std::string with(const std::function<void(std::type_identity_t<Kind>&)>& change) const {
    Kind changed;
    static_cast<SolidSpec&>(changed) = body;
    change(changed);
    return content_hash(changed);
  }

  testing::TemporaryFolder folder;
  QuasiStaticSpec body;
};

TEST_F(ContentHash, ChangesWithEveryKeyThatChangesAStoredNumber) {
  const auto region = [](QuasiStaticSpec& b) -> MaterialRegion& {
    b.materials.emplace_back();
    b.materials[0].where.group = "tumour";
    b.materials[0].material = {5e4, 0.3, 1000};
    return b.materials[0];
  };
  const std::vector<std::function<void(QuasiStaticSpec&)>> changes{
      [](QuasiStaticSpec&) {},
      [&](QuasiStaticSpec& b) { b.mesh = folder / "other.msh"; },
      [](QuasiStaticSpec& b) { b.scale = 0.001; },
      [](QuasiStaticSpec& b) { b.material.young = 2e4; },
      [](QuasiStaticSpec& b) { b.material.poisson = 0.4; },
      [](QuasiStaticSpec& b) {
        b.fixed[0].where.indices = {1, 2, 4};
      },
      [](QuasiStaticSpec& b) {
        b.fixed[0].axes = {true, true, false};
      },
      [](QuasiStaticSpec& b) { b.fixed.push_back(b.fixed[0]); },
      [](QuasiStaticSpec& b) {
        b.fixed[0].where = Selector{{}, Box{{0, 0, 0}, {1, 1, 1}}, ""};
      },
      [](QuasiStaticSpec& b) {
        b.fixed[0].where = Selector{{}, Box{{0, 0, 0}, {1, 1, 2}}, ""};
      },
      [](QuasiStaticSpec& b) {
        b.fixed[0].where = Selector{{}, {}, "base"};
      },
      [](QuasiStaticSpec& b) {
        b.touchable = NodeSelector{{{}, {}, "front"}};
      },
      [](QuasiStaticSpec& b) {
        b.touchable = NodeSelector{{{7, 8}, {}, ""}};
      },
      [](QuasiStaticSpec& b) {
        b.gravity = {0, 0, -9.81};
      },
      [](QuasiStaticSpec& b) {
        b.gravity = {0, 0, -9.81};
        b.material.density = 1100;
      },
      [](QuasiStaticSpec& b) {
        b.loads = {{Selector{{}, {}, "front"}, {0, 0, -1}, 0}};
      },
      [](QuasiStaticSpec& b) {
        b.loads = {{Selector{{}, {}, "front"}, {0, 0, -2}, 0}};
      },
      [](QuasiStaticSpec& b) {
        b.loads = {{Selector{{}, {}, "front"}, {0, 0, 0}, 100}};
      },
      [&](QuasiStaticSpec& b) { region(b); },
      [&](QuasiStaticSpec& b) { region(b).material.young = 6e4; },
      [&](QuasiStaticSpec& b) { region(b).where.group = "vessel"; },
      [&](QuasiStaticSpec& b) { b.nonlinear = Nonlinear{MeasuredLaw{.specimen_mesh = folder / "other.msh"}}; },
      [&](QuasiStaticSpec& b) {
        b.nonlinear = Nonlinear{MeasuredLaw{.specimen_mesh = folder / "other.msh", .specimen_scale = 0.5}};
      },
      [&](QuasiStaticSpec& b) { b.nonlinear = Nonlinear{NeoHookeanLaw{}}; },
      [&](QuasiStaticSpec& b) { b.nonlinear = Nonlinear{NeoHookeanLaw{.ball_radius = 0.004}}; },
      [&](QuasiStaticSpec& b) { b.nonlinear = Nonlinear{NeoHookeanLaw{.places = 4}}; },
  };
  std::set<std::string> hashes;
  for (const auto& change : changes) hashes.insert(with(change));
  EXPECT_EQ(hashes.size(), changes.size());
  for (const auto& hash : hashes) EXPECT_EQ(hash.size(), 32u);
}

TEST_F(ContentHash, CoversWhatBodiesThatMoveWithInertiaStore) {
  const auto tensor_mass = [&](auto change) { return with<TensorMassSpec>(change); };
  const auto hybrid = [&](const std::function<void(HybridSpec&)>& change) {
    return with<HybridSpec>([&](HybridSpec& b) {
      b.hybrid.regions.push_back({{{1, 2}, {}, ""}});
      change(b);
    });
  };
  const auto with_mesh = [&](const std::function<void(HybridSpec&)>& change) {
    return with<HybridSpec>([&](HybridSpec& b) {
      b.hybrid.mesh = folder / "other.msh";
      change(b);
    });
  };
  const auto original = tensor_mass([](MovingSpec&) {});
  const std::vector<std::string> hashes{
      content_hash(body),
      original,
      with<SpringMassSpec>([](MovingSpec&) {}),
      tensor_mass([](MovingSpec& b) { b.material.density = 1100; }),
      tensor_mass([](MovingSpec& b) {
        b.dynamic.gravity = {0, 0, -9.81};
      }),
      tensor_mass([](MovingSpec& b) { b.dynamic.element = TetElement::nodal_strain; }),
      tensor_mass([](MovingSpec& b) {
        b.materials.push_back({{{}, {}, "tumour"}, {5e4, 0.3, 1000}});
      }),
      tensor_mass([](MovingSpec& b) {
        b.materials.push_back({{{}, {}, "tumour"}, {5e4, 0.3, 1200}});
      }),
      hybrid([](HybridSpec&) {}),
      hybrid([](HybridSpec& b) {
        b.hybrid.regions[0].indices = {1, 3};
      }),
      hybrid([](HybridSpec& b) {
        b.hybrid.regions.push_back({{{3}, {}, ""}});
      }),
      hybrid([](HybridSpec& b) {
        b.dynamic.gravity = {0, 0, -9.81};
      }),
      hybrid([](HybridSpec& b) { b.material.density = 1100; }),
      with_mesh([](HybridSpec&) {}),
      with_mesh([](HybridSpec& b) { b.hybrid.scale = 0.5; }),
      with_mesh([&](HybridSpec& b) { b.hybrid.mesh = folder / "liver.msh"; }),
  };
  EXPECT_EQ(std::set(hashes.begin(), hashes.end()).size(), hashes.size());

  EXPECT_EQ(tensor_mass([](MovingSpec& b) {
              b.dynamic.damping = 1;
              b.tearing.emplace();
            }),
            original);
}

TEST_F(ContentHash, IgnoresWhatChangesNoStoredNumber) {
  const auto original = content_hash(body);
  EXPECT_EQ(with([](QuasiStaticSpec& b) { b.name = "another"; }), original);
  EXPECT_EQ(with([](QuasiStaticSpec& b) { b.material.density = 5; }), original);
  EXPECT_EQ(with([](QuasiStaticSpec& b) { b.nonlinear = Nonlinear{MeasuredLaw{.force_curve = "curve.csv"}}; }),
            original);
  put("copy.msh", "mesh one");
  EXPECT_EQ(with([&](QuasiStaticSpec& b) { b.mesh = folder / "copy.msh"; }), original);
}

TEST_F(ContentHash, ChangesWithTheContentOfTheMeshFile) {
  const auto original = content_hash(body);
  put("liver.msh", "mesh onf");
  EXPECT_NE(content_hash(body), original);
}

TEST_F(ContentHash, NamesAMeshFileThatCannotBeRead) {
  body.mesh = folder / "missing.msh";
  EXPECT_THROW(content_hash(body), std::runtime_error);
}

}  // namespace
}  // namespace palpate

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
    FixedRegion base;
    base.where.indices = {1, 2, 3};
    body.fixed = {base};
  }
  void put(const std::string& name, const std::string& text) {
    testing::write_bytes(folder / name, {text.begin(), text.end()}, text.size());
  }
  std::string with(const std::function<void(Body&)>& change) const {
    Body changed = body;
    change(changed);
    return content_hash(changed);
  }

  testing::TemporaryFolder folder;
  Body body;
};

TEST_F(ContentHash, ChangesWithEveryKeyThatChangesAStoredNumber) {
  const auto region = [](Body& b) -> MaterialRegion& {
    b.materials.emplace_back();
    b.materials[0].where.group = "tumour";
    b.materials[0].material = {5e4, 0.3, 1000};
    return b.materials[0];
  };
  const std::vector<std::function<void(Body&)>> changes{
      [](Body&) {},
      [&](Body& b) { b.mesh = folder / "other.msh"; },
      [](Body& b) { b.scale = 0.001; },
      [](Body& b) { b.material.young = 2e4; },
      [](Body& b) { b.material.poisson = 0.4; },
      [](Body& b) {
        b.fixed[0].where.indices = {1, 2, 4};
      },
      [](Body& b) {
        b.fixed[0].axes = {true, true, false};
      },
      [](Body& b) { b.fixed.push_back(b.fixed[0]); },
      [](Body& b) {
        b.fixed[0].where = Selector{{}, Box{{0, 0, 0}, {1, 1, 1}}, ""};
      },
      [](Body& b) {
        b.fixed[0].where = Selector{{}, Box{{0, 0, 0}, {1, 1, 2}}, ""};
      },
      [](Body& b) {
        b.fixed[0].where = Selector{{}, {}, "base"};
      },
      [](Body& b) {
        b.touchable = Selector{{}, {}, "front"};
      },
      [](Body& b) {
        b.touchable = Selector{{7, 8}, {}, ""};
      },
      [&](Body& b) { region(b); },
      [&](Body& b) { region(b).material.young = 6e4; },
      [&](Body& b) { region(b).where.group = "vessel"; },
      [&](Body& b) {
        b.nonlinear.emplace();
        b.nonlinear->specimen_mesh = folder / "other.msh";
      },
      [&](Body& b) {
        b.nonlinear.emplace();
        b.nonlinear->specimen_mesh = folder / "other.msh";
        b.nonlinear->specimen_scale = 0.5;
      },
  };
  std::set<std::string> hashes;
  for (const auto& change : changes) hashes.insert(with(change));
  EXPECT_EQ(hashes.size(), changes.size());
  for (const auto& hash : hashes) EXPECT_EQ(hash.size(), 32u);
}

TEST_F(ContentHash, CoversWhatBodiesThatMoveWithInertiaStore) {
  const auto tensor_mass = [](Body& b) { b.model = "tensor_mass"; };
  const auto hybrid = [](Body& b) {
    b.model = "hybrid";
    b.hybrid.emplace();
    b.hybrid->regions.push_back({{1, 2}, {}, ""});
  };
  const auto with_mesh = [&](Body& b) {
    b.model = "hybrid";
    b.hybrid.emplace();
    b.hybrid->mesh = folder / "other.msh";
  };
  const std::vector<std::function<void(Body&)>> changes{
      [](Body&) {},
      tensor_mass,
      [](Body& b) { b.model = "spring_mass"; },
      [&](Body& b) {
        tensor_mass(b);
        b.material.density = 1100;
      },
      [&](Body& b) {
        tensor_mass(b);
        b.materials.push_back({{{}, {}, "tumour"}, {5e4, 0.3, 1000}});
      },
      [&](Body& b) {
        tensor_mass(b);
        b.materials.push_back({{{}, {}, "tumour"}, {5e4, 0.3, 1200}});
      },
      hybrid,
      [&](Body& b) {
        hybrid(b);
        b.hybrid->regions[0].indices = {1, 3};
      },
      [&](Body& b) {
        hybrid(b);
        b.hybrid->regions.push_back({{3}, {}, ""});
      },
      [&](Body& b) {
        hybrid(b);
        b.dynamic.gravity = {0, 0, -9.81};
      },
      [&](Body& b) {
        hybrid(b);
        b.material.density = 1100;
      },
      with_mesh,
      [&](Body& b) {
        with_mesh(b);
        b.hybrid->scale = 0.5;
      },
      [&](Body& b) {
        with_mesh(b);
        b.hybrid->mesh = folder / "liver.msh";
      },
  };
  std::set<std::string> hashes;
  for (const auto& change : changes) hashes.insert(with(change));
  EXPECT_EQ(hashes.size(), changes.size());

  const auto original = with(tensor_mass);
  EXPECT_EQ(with([&](Body& b) {
              tensor_mass(b);
              b.dynamic.gravity = {0, 0, -9.81};
              b.dynamic.damping = 1;
              b.tearing.emplace();
            }),
            original);
}

TEST_F(ContentHash, IgnoresWhatChangesNoStoredNumber) {
  const auto original = content_hash(body);
  EXPECT_EQ(with([](Body& b) { b.name = "another"; }), original);
  EXPECT_EQ(with([](Body& b) { b.material.density = 5; }), original);
  EXPECT_EQ(with([](Body& b) {
              b.nonlinear.emplace();
              b.nonlinear->force_curve = "curve.csv";
            }),
            original);
  put("copy.msh", "mesh one");
  EXPECT_EQ(with([&](Body& b) { b.mesh = folder / "copy.msh"; }), original);
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

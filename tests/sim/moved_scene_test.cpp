// A scene that stands elsewhere is the same scene where tissue is cut as well: which of the triangles that share an
// edge is touched or cut does not hang on rounding.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "common/devices/device.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/scene/scene.hpp"
#include "common/sim/simulator.hpp"
#include "tools/rig/kinds.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// A scene of one body that moves, played step by step by its tools' own motions. In double precision: single rounds
/// the tissue's forces by 1e-7, which the strokes of loose flaps on the tool make more and more of.
class Played {
 public:
  Played(const std::string& name, const Vector3d& at) : scene_(load_scene(PALPATE_SOURCE_DIR "/scenes/" + name)) {
    move(at);
    simulator_.emplace(scene_, archives_);
    devices_ = make_devices(scene_.tools, scene_.rates.haptic_hz);
    simulator_->start(inputs(0));
  }

  void step(int k) {
    simulator_->step(inputs(k));
    for (const sim::ChangeView& change : simulator_->changes())
      removed_.insert(removed_.end(), change.removed.begin(), change.removed.end());
  }
  int tools() const { return simulator_->tools(); }
  Vector3d force(int tool) const { return simulator_->tool(tool).force; }
  const std::vector<int>& removed() const { return removed_; }  ///< tetrahedra so far, in order

 private:
  void move(const Vector3d& at) {
    std::visit(
        [&](auto& body) {
          if constexpr (std::derived_from<std::decay_t<decltype(body)>, MovingSpec>) {
            body.dynamic.precision = Precision::float64;
            TetMesh mesh = load_tet_mesh(body.mesh, body.scale);
            for (Vector3d& node : mesh.nodes) node += at;
            for (BoundaryCondition& held : body.fixed)
              if (held.where.box) held.where.box = Box{held.where.box->min + at, held.where.box->max + at};
            archives_.push_back(precompute_on(body, mesh));
          }
        },
        scene_.bodies.at(0));
    for (Tool& tool : scene_.tools) tool.pivot += at;
  }
  std::vector<sim::ToolInput> inputs(int k) {
    std::vector<sim::ToolInput> inputs;
    for (const auto& device : devices_) inputs.push_back(device->read(1e-3 * k));
    return inputs;
  }

  Scene scene_;
  std::vector<Archive> archives_;
  std::optional<sim::Simulator> simulator_;
  std::vector<std::unique_ptr<Device>> devices_;
  std::vector<int> removed_;
};

/// For so many ticks, in which `cut` tetrahedra or more go.
void is_the_same_half_a_metre_away(const std::string& name, int ticks, std::size_t cut) {
  Played here(name, Vector3d::Zero()), there(name, {0.5, 0.25, -0.125});
  double apart = 0, largest = 0;
  for (int k = 1; k <= ticks && !::testing::Test::HasFailure(); ++k) {
    here.step(k);
    there.step(k);
    ASSERT_EQ(here.removed(), there.removed()) << "tick " << k;
    for (int t = 0; t < here.tools(); ++t) {
      apart = std::max(apart, (here.force(t) - there.force(t)).norm());
      largest = std::max(largest, here.force(t).norm());
      EXPECT_LT((here.force(t) - there.force(t)).norm(), 1e-6) << "tick " << k;
    }
  }
  fmt::print("{}: forces of {:.3f} N differ by {:.2g} N at most\n", name, largest, apart);
  EXPECT_GT(largest, 0.05);
  EXPECT_GE(here.removed().size(), cut);
}

TEST(MovedScene, OfACutPlateIsTheSame) {
  is_the_same_half_a_metre_away("plate_cut.toml", 5700, 170);
}

TEST(MovedScene, OfALobeCutOffIsTheSame) {
  is_the_same_half_a_metre_away("hepatectomy.toml", 10000, 342);
}

}  // namespace
}  // namespace palpate

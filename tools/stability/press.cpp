#include "tools/stability/press.hpp"

#include <algorithm>

#include "tools/rig/kinds.hpp"
#include "tools/stability/watch.hpp"

namespace palpate::stability {

Result press(const Scene& scene, const TetMesh& mesh, const Path& path, int steps) {
  std::vector<Archive> archives;
  for (const Body& body : scene.bodies) archives.push_back(precompute_on(body, mesh));
  PressRig rig(scene, std::move(archives));
  rig.start(path(0));
  Watch watch;
  for (int i = 1; i <= steps; ++i) {
    rig.step(path(i));
    watch.look(rig.haptic());
  }
  return watch.result();
}

Path down_and_up(double above, double depth, int ticks) {
  return [=](int i) {
    const double share = i < ticks ? 1.0 * i / ticks : i < 2 * ticks ? 1.0 : std::max(0.0, 3.0 - 1.0 * i / ticks);
    return Eigen::Vector3d(0, 0, above - share * (above + depth));
  };
}

PressedTissue press_tissue(const Scene& scene, const TetMesh& mesh, const Path& path, int ticks, bool pedal) {
  PressRig rig(scene, {precompute_on(scene.bodies[0], mesh)});
  TissueWatch watch;
  for (int i = 0; i < ticks; ++i) {
    ToolDofs dofs = tip_at(scene.tools[0], path(i));
    dofs.pedal = pedal;
    rig.press(std::array{dofs});
    watch.look(rig.organ(), work_on(rig.tissue(), 0));
  }
  return {watch.result(), rig.organ().removed().size(), rig.organ().mesh().tetrahedra.size()};
}

Result press_tissue(const Scene& scene, const TetMesh& mesh, double depth, int ticks) {
  const double high = 0.02 + 0.0061, low = 0.026 - depth;
  const auto path = [=](int i) {
    const double share = std::min(1.0, 2.0 * std::min(i, ticks - i) / ticks * 2);
    return Eigen::Vector3d(0, 0, high - share * (high - low));
  };
  return press_tissue(scene, mesh, path, ticks).result;
}

}  // namespace palpate::stability

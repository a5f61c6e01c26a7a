#pragma once
#include <functional>

#include "common/mesh/tet_mesh.hpp"
#include "tools/stability/case.hpp"

namespace palpate::stability {

/// Where the tip is [m] at a tick.
using Path = std::function<Eigen::Vector3d(int)>;

/// Runs the tool's tip through `path`, `steps` steps, in the scene whose bodies are all of `mesh`.
Result press(const Scene& scene, const TetMesh& mesh, const Path& path, int steps);

/// Down from above to `depth` [m] below z = 0 within `ticks`, a while there, and up again.
Path down_and_up(double above, double depth, int ticks);

/// What became of moving tissue, see TissueWatch.
struct PressedTissue {
  Result result;
  std::size_t removed, tetrahedra;
};
/// The tip's path through a body that moves, which is alone moved on: without what the hand feels of it.
PressedTissue press_tissue(const Scene& scene, const TetMesh& mesh, const Path& path, int ticks, bool pedal = false);
/// A block of 20 mm height is pressed to `depth` [m] and left, `ticks` in all.
Result press_tissue(const Scene& scene, const TetMesh& mesh, double depth, int ticks);

}  // namespace palpate::stability

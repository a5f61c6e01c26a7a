#pragma once
#include <string>

#include "common/archive/archive.hpp"
#include "common/fem/offline_spec.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// What the tensors of a quasi-static body take to compute.
struct TensorWork {
  double operations = 0;    ///< [flop] worth of dense algebra
  double factor_bytes = 0;  ///< of the sparse factor
};

/// Of a body that can be touched at the touchable nodes of `surface`, by the analysis of the sparse system that is
/// solved.
TensorWork tensor_work(const TetMesh& mesh, const SurfaceMap& surface, const Offline& offline);

/// How long that takes here and now, by the speed of a dense product on all cores: "about 38 s on this machine".
struct WorkTime {
  double seconds;
  std::string words;
};
WorkTime time_of(const TensorWork& work);

}  // namespace palpate

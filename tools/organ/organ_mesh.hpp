#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tools/organ/fill_solid.hpp"

namespace palpate {

/// How fine a mesh is asked for.
struct MeshFineness {
  int nodes = 1500;      ///< aimed at where `edge` is 0
  double edge = 0;       ///< [m] on the surface
  double inside = 0;     ///< [m] inside; 0: 2.5 times that on the surface
  double deviation = 0;  ///< [m] of the surface from the solid's; 0: a twelfth of the edge
  std::vector<FinePlace> fine;
};

/// What a solid should have, for its mesh to be brought to.
struct SolidMeasures {
  double area;                  ///< [m^2]
  std::vector<double> volumes;  ///< [m^3] of its parts; empty: not known, the mesh's are what they come to
};

/// Fills a solid as finely as is asked, moves the surface's nodes so that the volume is the solid's, and checks the
/// mesh. `say` hears what is being done. Throws std::runtime_error.
FilledSolid make_organ_mesh(const Solid& solid, const SolidMeasures& measures, const MeshFineness& fineness,
                            const std::function<void(const std::string&)>& say);

}  // namespace palpate

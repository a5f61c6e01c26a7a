#pragma once
#include <optional>

#include "common/fem/offline_spec.hpp"
#include "common/fem/solid_spec.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// How a specimen answers a press between two plates that hold its ends by their full faces.
struct SpecimenSlopes {
  double force;   ///< [N/m] axial force per displacement of the upper plate
  double radial;  ///< [1] mean outward displacement of the side nodes nearest to mid-height (a band of
                  ///< two per cent of the height), per displacement
};

/// Presses a specimen along -z: its lowest nodes are fixed, its highest move along -z with x and y held. The
/// axis is the vertical through the middle of the specimen's bounding box. `offline`: the better discretisation of the
/// body that is to answer as the specimen does.
SpecimenSlopes press_specimen(const TetMesh& mesh, const Material& material,
                              const std::optional<Offline>& offline = {});

}  // namespace palpate

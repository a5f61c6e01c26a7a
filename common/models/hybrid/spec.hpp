#pragma once
#include <string_view>
#include <vector>

#include "common/models/moving_kind.hpp"

namespace palpate {

/// Which part of a hybrid body is tensor-mass; either regions or a mesh is set in a validated scene.
struct Hybrid {
  std::vector<ElementSelector> regions;  ///< elements of the body's mesh: the tensor-mass part
  std::filesystem::path mesh;            ///< a coarse tensor-mass mesh joined where its nodes coincide with the body's
  double scale = 1;                      ///< [m per unit of mesh]
};

inline void describe(Description& d, Hybrid& h) {
  d.file({"mesh", "",
          "a tensor-mass part with a mesh of its own, often a coarser one, joined to the quasi-static body where nodes "
          "of the two coincide",
          Need::optional, Use::stored},
         h.mesh);
  d.number({"scale", "m", "length of that mesh's unit", Need::optional, Use::stored}, h.scale, above(0));
  d.only_with("scale", "mesh");
  d.tables({"region", "", "the tetrahedra of the tensor-mass part, which add up; the others are quasi-static",
            Need::optional, Use::stored},
           h.regions);
  d.require(h.regions.empty() != h.mesh.empty(), "",
            fmt::format("[body.hybrid] needs a [[body.hybrid.region]] or a 'mesh', and has {}",
                        h.mesh.empty() ? "neither" : "both"));
}

/// One body of a quasi-static and a tensor-mass part that act on each other (RR3510 sec. 6).
struct HybridSpec : MovingSpec {
  static constexpr std::string_view kKind = "hybrid";
  Hybrid hybrid;
};

inline void describe(Description& d, HybridSpec& b) {
  describe(d, static_cast<MovingSpec&>(b));
  d.table({"hybrid", "", "which part is tensor-mass", Need::required, Use::stored}, b.hybrid);
}

FreeVibration vibration(const HybridSpec& body);
DirectProblem direct_problem(const HybridSpec& body);
std::vector<std::string> archive_lines(const HybridSpec& body, const Archive& archive);
ArchiveJob archive_job(const HybridSpec& body, const Progress& progress);

inline bool has_own_mesh(const HybridSpec& body) {
  return !body.hybrid.mesh.empty();
}

}  // namespace palpate

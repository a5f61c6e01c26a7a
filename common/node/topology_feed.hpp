#pragma once
#include <memory>

#include "common/mesh/shown_surface.hpp"
#include "common/node/topology_memory.hpp"

namespace palpate {

/// Follows the cuts of a scene's dynamic bodies in a node that draws them.
class TopologyFeed {
 public:
  /// One archive per body.
  TopologyFeed(Bus& bus, const Presence& presence, const std::vector<Archive>& archives);

  /// Takes what has come; the bodies whose surface has changed, ascending.
  std::vector<int> take();
  /// What is seen of a body that can be cut: outward triangles over its surface nodes. Valid until the next call.
  const std::vector<std::array<int, 3>>& triangles(int body) {
    return bodies_.at(body).shown->triangles(*bodies_.at(body).mesh);
  }
  /// Which piece of such a body each of its tetrahedra belongs to: -1 for one that is gone, 0 for what is joined to a
  /// rest that cannot be cut, then from 1. Valid until the next call.
  std::span<const int> pieces(int body);
  /// Tetrahedra that tools have cut, not torn or fallen away.
  std::span<const int> cut(int body) const { return memory_.cut(body); }
  const CutMesh& mesh(int body) const { return *bodies_.at(body).mesh; }
  std::size_t cuts() const;                                    ///< tetrahedra gone, of all bodies
  std::uint64_t refused() const { return memory_.refused(); }  ///< messages that do not fit the archives

 private:
  struct Followed {
    std::vector<std::array<int, 4>> tetrahedra;
    int nodes = 0;
    std::unique_ptr<CutMesh> mesh;
    std::unique_ptr<ShownSurface> shown;
    std::uint64_t run = 0;
    std::vector<int> piece;  ///< per tetrahedron
  };

  TopologyMemory memory_;
  std::map<int, Followed> bodies_;
};

}  // namespace palpate

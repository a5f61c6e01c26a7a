#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/bus/presence.hpp"
#include "common/mesh/shown_surface.hpp"
#include "common/tensors/archive.hpp"

namespace palpate {

/// Follows the cuts of a scene's dynamic bodies in a node that does not own them. A node that comes late receives all
/// cuts so far; where one is missing it asks for all of them anew. When the deformation node starts again, so do the
/// bodies.
class TopologyFeed {
 public:
  /// One archive per body; those without tetrahedra cannot be cut and are not followed.
  TopologyFeed(Bus& bus, const Presence& presence, const std::vector<Archive>& archives);

  /// Takes what has come; the bodies whose surface has changed, ascending.
  std::vector<int> take();
  /// What is seen of a body that can be cut: outward triangles over its surface nodes. Valid until the next call.
  const std::vector<std::array<int, 3>>& triangles(int body) { return bodies_.at(body).shown->triangles(*bodies_.at(body).mesh); }
  const CutMesh& mesh(int body) const { return *bodies_.at(body).mesh; }
  std::uint64_t cuts() const { return cuts_; }        ///< tetrahedra gone, of all bodies
  std::uint64_t refused() const { return refused_; }  ///< messages that do not fit the archives

 private:
  struct Followed {
    std::vector<std::array<int, 4>> tetrahedra;
    int nodes = 0;
    std::unique_ptr<CutMesh> mesh;
    std::unique_ptr<ShownSurface> shown;
    std::uint64_t seq = 0;
  };
  void start_again(std::vector<int>& changed);
  bool apply(const TopologyChange& change, std::vector<int>& changed);
  std::uint64_t owner() const;

  Bus& bus_;
  const Presence& presence_;
  std::unique_ptr<Reader<TopologyChange>> reader_;
  std::map<int, Followed> bodies_;
  std::uint64_t run_ = 0, cuts_ = 0, refused_ = 0;
};

}  // namespace palpate

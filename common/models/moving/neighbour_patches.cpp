#include "common/models/moving/neighbour_patches.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

using Eigen::Vector3d;

// By which all others may let a patch sink beyond what the nodes do, of what it gives way by. Patches that lie near
// each other on a thin body would do more.
constexpr double kMostByOthers = 0.05;

}  // namespace

void NeighbourPatches::add(Patch& patch, const std::vector<int>& nodes) {
  all_.push_back({patch, nodes});
  all_.back().beside.reserve(patch.max_nodes());
  all_.back().moved.reserve(Patch::kMaxNodes);
}

// Each pair knows of each other by the same share.
void NeighbourPatches::meet(int number) {
  One& own = all_[number];
  own.sunk = 0;
  for (One& other : all_)
    if (meets(own, other)) own.sunk += find_met(own, other);
  Patch::OfCells dents{};
  own.beside.assign(own.nodes.size(), Vector3d::Zero());
  for (const One& other : all_) {
    if (!meets(own, other)) continue;
    const double share = kMostByOthers / std::max({kMostByOthers, own.sunk, other.sunk});
    for (std::size_t p = 0; p < dents.size(); ++p) dents[p] += share * other.dents[p];
    for (std::size_t i = 0; i < own.nodes.size(); ++i) own.beside[i] += share * other.moved[i];
  }
  own.patch.lie_in(dents);
}

bool NeighbourPatches::meets(const One& own, const One& other) {
  return &other != &own && other.patch.touches();
}

// [1] By how much it sinks, of what the larger one's force would do between two such patches in one place.
double NeighbourPatches::find_met(const One& own, One& other) const {
  own.patch.find_dents(other.patch, other.dents);
  other.moved.assign(own.nodes.size(), Vector3d::Zero());
  for (const PatchForce& f : other.patch.forces())
    for (std::size_t i = 0; i < own.nodes.size(); ++i)
      other.moved[i] += near_field_->between(own.nodes[i], f.node) * f.force;
  const double gives =
      std::max(own.patch.pressing(), other.patch.pressing()) * std::sqrt(own.patch.softness() * other.patch.softness());
  return gives > 0 ? std::abs(own.patch.sunk(other.dents, other.moved)) / gives : 0;
}

}  // namespace palpate

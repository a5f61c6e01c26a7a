#include "common/models/moving/cuttable_tissue.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "common/contact/tool_contacts.hpp"
#include "common/geometry/triangle.hpp"

namespace palpate {
namespace {

constexpr double kLostBeyond = 3;           // diagonals from its place, beyond which a part that floats is taken away
constexpr int kMaxCuts = 4, kMaxTears = 8;  // tetrahedra that one tick takes away, conformity's apart

}  // namespace

CuttableTissue::CuttableTissue(const Archive& archive, const MovingSpec& body, const StepSettings& settings,
                               const ElasticMesh& mesh, DynamicModel& model, std::span<const int> joined)
    : mesh_(mesh),
      model_(model),
      topology_(mesh.tetrahedra, mesh.nodes()),
      shown_(archive.surface.triangles, topology_),
      surface_(topology_, mesh.rest, bucket_size(settings.contact, archive.surface)),
      fading_(settings.dt),
      joined_(mesh.nodes(), 0),
      damping_(body.dynamic.damping) {
  if (archive.condensed) topology_.join(shown_.joints());
  surface_.hide(shown_.joints());
  for (int node = 0; node < mesh.nodes(); ++node)
    if (std::ranges::all_of(mesh.fixed[node], std::identity{})) surface_.fix(node);
  for (const int node : joined) joined_[node] = 1;
  if (body.tearing) tearing_.emplace(mesh, body.tearing->criterion, body.tearing->threshold, kMaxTears);
  Eigen::Vector3d low = mesh.rest[0], high = low;
  for (const Eigen::Vector3d& x : mesh.rest) low = low.cwiseMin(x), high = high.cwiseMax(x);
  diagonal_ = (high - low).norm();
  middle_ = 0.5 * (low + high);
}

bool CuttableTissue::cut(std::span<const Glow> glows) {
  const std::size_t first = removed_.size();
  for (const auto& [tip, radius] : glows)
    for (int i = 0; i < kMaxCuts; ++i) {
      double least = radius * radius;
      int nearest = -1;
      for (int facet : surface_.find(tip, tip, radius)) {
        const double squared = closest_point(tip, surface_.corners(facet)).squared_distance;
        if (!is_nearer(squared, least)) continue;
        least = squared;
        nearest = facet;
      }
      if (nearest < 0) break;
      remove(nearest / 4);
    }
  return note_change(RemovalCause::cut, first);
}

bool CuttableTissue::tear(std::span<const Eigen::Vector3d> position) {
  if (!tearing_) return false;
  const std::size_t first = removed_.size();
  for (int t : tearing_->find(position))
    if (topology_.alive(t)) remove(t);
  return note_change(RemovalCause::torn, first);
}

bool CuttableTissue::drop_fallen(std::span<const Eigen::Vector3d> position) {
  const std::size_t first = removed_.size();
  for (const FloatingPart& part : floating_) {
    const Eigen::Vector3d& at = position[part.nodes()[0]];
    if ((at - middle_).squaredNorm() < kLostBeyond * kLostBeyond * diagonal_ * diagonal_) continue;
    std::vector<char> of_it(mesh_.nodes(), 0);
    for (const int n : part.nodes()) of_it[n] = 1;
    std::vector<int> gone;
    for (int t = 0; t < topology_.size(); ++t)
      if (topology_.alive(t) && of_it[topology_.tetrahedron(t)[0]]) gone.push_back(t);
    topology_.erase(gone);
    surface_.follow();
    removed_.insert(removed_.end(), gone.begin(), gone.end());
  }
  return note_change(RemovalCause::fell_away, first);
}

bool CuttableTissue::has(std::span<const std::uint32_t> tetrahedra) const {
  return std::ranges::all_of(tetrahedra,
                             [&](std::uint32_t t) { return t < static_cast<std::uint32_t>(topology_.size()); });
}

bool CuttableTissue::begin_without(std::span<const std::uint32_t> removed) {
  topology_.erase(std::vector<int>(removed.begin(), removed.end()));
  std::vector<char> listed(topology_.size(), 0);
  for (const std::uint32_t t : removed)
    if (!std::exchange(listed[t], 1)) removed_.push_back(static_cast<int>(t));
  surface_.follow();
  return note_change(RemovalCause::gone_before, 0);
}

void CuttableTissue::begin_tick() {
  changes_.clear();
  for (const FloatingPart& part : floating_) part.unload(model_);
  fading_.fade(model_);
  for (FloatingPart& part : floating_) part.keep_loads(model_);
}

void CuttableTissue::begin_step(std::span<const JawHold> held, double dt) {
  for (FloatingPart& part : floating_) part.give_back_damping(model_, mesh_.rest, held, dt);
}

void CuttableTissue::fade(int node, const Eigen::Vector3d& force) {
  if (fades(node)) fading_.add(node, force);
}

void CuttableTissue::remove(int tetrahedron) {
  topology_.remove(tetrahedron, removed_);
  surface_.follow();
}

bool CuttableTissue::note_change(RemovalCause cause, std::size_t first) {
  if (first == removed_.size()) return false;
  changes_.push_back({cause, {removed_.begin() + static_cast<std::ptrdiff_t>(first), removed_.end()}});
  const std::vector<int>& gone = changes_.back().removed;
  if (cause == RemovalCause::cut)
    cut_from_model(gone);
  else
    model_.remove(gone);
  if (tearing_) tearing_->remove(gone);
  find_floating();
  return true;
}

bool CuttableTissue::fades(int node) const {
  return topology_.has_node(node) && !joined_[node];
}

// What the tetrahedra did to the nodes that stay fades; gone at once, it would be a blow to what presses them.
void CuttableTissue::cut_from_model(std::span<const int> gone) {
  std::vector<int> nodes;
  for (const int t : gone) nodes.insert(nodes.end(), mesh_.tetrahedra[t].begin(), mesh_.tetrahedra[t].end());
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  std::erase_if(nodes, [&](int n) { return !fades(n); });
  std::vector<Eigen::Vector3d> before;
  for (const int n : nodes) before.push_back(model_.elastic_force(n));
  model_.remove(gone);
  for (std::size_t i = 0; i < nodes.size(); ++i) fading_.add(nodes[i], before[i] - model_.elastic_force(nodes[i]));
}

void CuttableTissue::find_floating() {
  const int parts = topology_.parts(part_of_);
  std::vector<char> held(parts, 0), listed(mesh_.nodes(), 0);
  std::vector<std::vector<int>> nodes(parts);
  for (int t = 0; t < topology_.size(); ++t) {
    const int part = part_of_[t];
    if (part < 0) continue;
    for (int node : topology_.tetrahedron(t)) {
      held[part] |= joined_[node] || mesh_.fixed[node][0] || mesh_.fixed[node][1] || mesh_.fixed[node][2];
      if (!std::exchange(listed[node], 1)) nodes[part].push_back(node);
    }
  }
  floating_.clear();
  for (int part = 0; part < parts; ++part)
    if (!held[part]) floating_.emplace_back(std::move(nodes[part]), damping_);
}

void CuttableTissue::state(State& s) {
  std::vector<int> removed = removed_;
  s.list(removed);
  fading_.state(s);
  if (!s.restoring()) return;
  const bool own = std::ranges::all_of(removed, [&](int t) { return t >= 0 && t < topology_.size(); });
  s.require(removed_.empty() && own && fading_.fits(mesh_.nodes()), State::kOfAnother);
  restore(removed);
}

void CuttableTissue::restore(std::span<const int> removed) {
  removed_.assign(removed.begin(), removed.end());
  topology_.erase(removed_);
  surface_.follow();
  model_.remove(removed_);
  if (tearing_) tearing_->remove(removed_);
  find_floating();
}

}  // namespace palpate

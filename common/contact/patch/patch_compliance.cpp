// By how much the tissue gives way under the squares of a patch.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/contact/patch/patch.hpp"

namespace palpate {
namespace {

// Of a square's own compliance: the least that pressures of any pattern find beyond the nodes'.
constexpr double kMinGive = 0.02, kTolerated = 0.001;

template <int N>
void add_to_each(const double* from, double number, double* to) {
  using Numbers = Eigen::Array<double, N, 1>;
  Eigen::Map<Numbers> sum(to);
  sum = Eigen::Map<const Numbers>(from) + number;
}

}  // namespace

// From one step to the next the nodes are mostly the same: they keep their places, and new ones come where others went.
void Patch::fill_near_field(const NearField& near_field) {
  constexpr int kNone = -1;
  const std::size_t count = nodes_.size();
  std::array<bool, kMaxNodes> kept{};
  place_.assign(count, kNone);
  for (std::size_t i = 0; i < count; ++i) {
    const auto found = std::ranges::find(known_, nodes_[i]);
    if (found != known_.end()) kept[place_[i] = static_cast<int>(found - known_.begin())] = true;
  }
  for (std::size_t p = 0; p < known_.size(); ++p)
    if (!kept[p]) known_[p] = kNone;
  while (!known_.empty() && known_.back() == kNone) known_.pop_back();
  for (std::size_t i = 0; i < count; ++i) {
    if (place_[i] != kNone) continue;
    const auto vacant = std::ranges::find(known_, kNone);
    place_[i] = static_cast<int>(vacant - known_.begin());
    if (vacant == known_.end()) known_.push_back(kNone);
    known_[place_[i]] = nodes_[i];
    for (std::size_t k = 0; k < count; ++k)
      if (place_[k] != kNone) near_field_.set(place_[i], place_[k], near_field.between(nodes_[i], nodes_[k]));
  }
}

// The compliance between squares along the normal [m/N].
void Patch::fill_normal() {
  for (int i = 0; i < grid_.feet(); ++i) direction_[i] = direction(i);
  fill_feet(near_field_, place_, static_cast<int>(known_.size()));
  list_laid();
  const int n = grid_.size();
  aside_ = give_aside();
  for (const int q : rows_) fill_cell(q);
  // A cell of which little lies over tissue gives little force: at an edge it comes and goes by and by.
  for (const int p : rows_) compliance_[p * n + p] += (1 / cells_[p].cover - 1) * kernel_.own();
}

// [m/N] What forces at feet do to feet, each along its own direction, by what nodes do to nodes.
void Patch::fill_feet(const NodeBlocks& nodes, std::span<const int> place, int places) {
  const int feet = grid_.feet();
  auto& [x, y, z] = moved_places_;
  for (int b = 0; b < feet; ++b) {
    const Foot& from = feet_[b];
    if (!from.stands()) continue;
    for (std::vector<double>* moved : {&x, &y, &z}) std::fill_n(moved->begin(), places, 0.0);
    for (int v = 0; v < 3; ++v)
      nodes.add_moved(from.weights[v] * direction_[b], place[from.local[v]], places, x.data(), y.data(), z.data());
    for (int a = b; a < feet; ++a) {
      const Foot& f = feet_[a];
      if (!f.stands()) continue;
      double sum = 0;
      for (int v = 0; v < 3; ++v) {
        const int i = place[f.local[v]];
        sum += f.weights[v] * (direction_[a].x() * x[i] + direction_[a].y() * y[i] + direction_[a].z() * z[i]);
      }
      k_feet_[b * feet + a] = k_feet_[a * feet + b] = sum;
    }
  }
}

// G + K between cell q and all others.
void Patch::fill_cell(int q) {
  double* const row = &compliance_[q * grid_.size()];
  const double* const at_feet = &k_feet_[grid_.foot(q) * grid_.feet()];
  for (int column = 0; column < grid_.columns(); ++column) {
    const int begin = grid_.first(column), count = grid_.first(column + 1) - begin;
    const double* const pressed = kernel_.pressed(std::abs(column - grid_.column(q)), grid_.row(q)) + grid_.row(begin);
    if (grid_.column_feet())
      add_to_each<PatchGrid::kStripRows>(pressed, at_feet[column], row + begin);
    else
      for (int i = 0; i < count; ++i) row[begin + i] = pressed[i] + at_feet[begin + i];
  }
  if (grid_.strip()) return;
  kernel_.add_leaning(q, leans_, row);
  for (int p = 0; p < grid_.size(); ++p) row[p] += aside_ * leans_ * leans_ * grid_.lean(p).dot(grid_.lean(q));
}

// Where the nodes lie closer than the squares, or are softer than the half-space under forces on single ones, they know
// of patterns that G does not: without these L is none the less to be positive, or the contact would put out work.
// Anew in each tick: what is kept from another place makes the force jump.
void Patch::keep_positive() {
  if (!is_positive()) raise_eigenvalues();
}

bool Patch::is_positive() {
  list_laid();
  const int n = grid_.size(), m = static_cast<int>(rows_.size());
  const std::ptrdiff_t ld = kernels::leading_dimension(n);
  for (int c = 0; c < m; ++c) {
    for (int r = c; r < m; ++r) factor_[ld * c + r] = compliance_[rows_[r] * n + rows_[c]];
    floor_[c] = kTolerated * kernel_.own();
  }
  return kernels::active().cholesky(factor_.data(), m, ld, floor_.data()) == 0;
}

void Patch::list_laid() {
  rows_.clear();
  for (int p = 0; p < grid_.size(); ++p)
    if (laid(p)) rows_.push_back(p);
}

// Those that are too small.
void Patch::raise_eigenvalues() {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxCells, kMaxCells>;
  const int n = grid_.size(), m = static_cast<int>(rows_.size());
  Matrix a(m, m);
  for (int r = 0; r < m; ++r)
    for (int c = 0; c < m; ++c) a(r, c) = compliance_[rows_[r] * n + rows_[c]];
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(a);
  const double least = kMinGive * kernel_.own();
  for (int k = 0; k < m && eigen.eigenvalues()[k] < least; ++k) {
    const double raise = least - eigen.eigenvalues()[k];
    for (int r = 0; r < m; ++r)
      for (int c = 0; c < m; ++c)
        compliance_[rows_[r] * n + rows_[c]] += raise * eigen.eigenvectors()(r, k) * eigen.eigenvectors()(c, k);
  }
}

// What a step's forces do to the nodes, to all squares over them.
void Patch::add_nodes_give(std::span<const NodeGive> give) {
  const int count = static_cast<int>(nodes_.size()), n = grid_.size();
  std::array<int, kMaxNodes> same;
  std::iota(same.begin(), same.begin() + count, 0);
  nodes_give_.clear(count);
  for (const auto& [i, j, block] : give) nodes_give_.set(i, j, block);
  fill_feet(nodes_give_, std::span(same).first(count), count);
  for (const int p : rows_)
    for (const int q : rows_) compliance_[p * n + q] += k_feet_[grid_.foot(p) * grid_.feet() + grid_.foot(q)];
}

// [m/N] K between a force that the nodes share and what they all do, in such shares.
Eigen::Matrix3d Patch::shared_near_field(std::span<const double> share) const {
  Eigen::Matrix3d k = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < share.size(); ++i)
    for (std::size_t j = 0; share[i] != 0 && j < share.size(); ++j)
      if (share[j] != 0) near_field_.add(place_[i], place_[j], share[i] * share[j], k);
  return k;
}

// [m/N] Of one shear that is spread as the pressures are, by G and K. Elements may be softer to shear than all that
// lies beyond them: without a floor, as that under the pressures, the shear would put out work.
Eigen::Matrix2d Patch::compliance_to_shear(const Eigen::Matrix<double, 3, 2>& plane,
                                           std::span<const double> share) const {
  Eigen::Matrix2d c = Eigen::Matrix2d::Zero();
  for (const int p : rows_)
    for (const int q : rows_) {
      if (q > p) break;
      c += (q < p ? 2 : 1) * pressure_force_[p] * pressure_force_[q] * kernel_.sheared(p, q);
    }
  c /= pressing_ * pressing_;
  const double least = kMinGive * 0.5 * c.trace();
  c += plane.transpose() * shared_near_field(share) * plane;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(c);
  if (eigen.eigenvalues()[0] >= least) return c;
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(least).asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace palpate

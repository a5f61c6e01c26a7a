// By how much the tissue gives way under the squares of a patch.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "common/contact/patch/patch.hpp"

namespace palpate {
namespace {

// Of a square's own compliance: the least that pressures of any pattern find beyond the nodes'.
constexpr double kMinGive = 0.02, kTolerated = 0.001;

}  // namespace

// From one step to the next the nodes are mostly the same.
void Patch::fill_near_field(const NearField& near_field) {
  if (nodes_ == known_) return;
  known_ = nodes_;
  has_more_ = false;
  const int count = static_cast<int>(nodes_.size());
  for (int i = 0; i < count; ++i)
    for (int j = 0; j <= i; ++j) {
      const Eigen::Matrix3d block = near_field.between(nodes_[i], nodes_[j]);
      near_field_[i * kMaxNodes + j] = block;
      near_field_[j * kMaxNodes + i] = block.transpose();
    }
}

// The compliance between squares along the normal [m/N].
void Patch::fill_normal() {
  const int n = grid_.size(), count = static_cast<int>(nodes_.size());
  for (int i = 0; i < count; ++i)
    for (int j = 0; j <= i; ++j)
      k_[i * kMaxNodes + j] = k_[j * kMaxNodes + i] = normal_.dot(near_field_[i * kMaxNodes + j] * normal_);
  for (int a = 0; a < grid_.feet(); ++a) {
    if (!feet_[a].stands()) continue;
    fill_at_foot(feet_[a], k_);
    for (int b = 0; b <= a; ++b)
      if (feet_[b].stands()) k_feet_[a * grid_.feet() + b] = k_feet_[b * grid_.feet() + a] = at_foot(feet_[b]);
  }
  list_laid();
  for (const int p : rows_) {
    const double* const at_feet = &k_feet_[grid_.foot(p) * grid_.feet()];
    for (const int q : rows_) {
      if (q > p) break;
      compliance_[p * n + q] = compliance_[q * n + p] = kernel_.pressed(p, q) + at_feet[grid_.foot(q)];
    }
  }
  // A cell of which little lies over tissue gives little force: at an edge it comes and goes by and by.
  for (const int p : rows_) compliance_[p * n + p] += (1 / cells_[p].cover - 1) * kernel_.own();
}

// Where the nodes lie closer than the squares, they know of patterns that G does not: without these L is none the less
// to be positive, or the contact would put out work.
void Patch::keep_positive() {
  if (has_more_) add_more(1);
  if (is_positive()) return;
  if (has_more_) add_more(-1);
  find_more();
  add_more(1);
}

void Patch::add_more(double sign) {
  for (std::size_t i = 0; i < more_.size(); ++i) compliance_[i] += sign * more_[i];
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

// The eigenvalues that are too small are raised.
void Patch::find_more() {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxSquares, kMaxSquares>;
  const int n = grid_.size(), m = static_cast<int>(rows_.size());
  Matrix a(m, m);
  for (int r = 0; r < m; ++r)
    for (int c = 0; c < m; ++c) a(r, c) = compliance_[rows_[r] * n + rows_[c]];
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(a);
  const double least = kMinGive * kernel_.own();
  std::ranges::fill(more_, 0.0);
  for (int k = 0; k < m && eigen.eigenvalues()[k] < least; ++k) {
    const double raise = least - eigen.eigenvalues()[k];
    for (int r = 0; r < m; ++r)
      for (int c = 0; c < m; ++c)
        more_[rows_[r] * n + rows_[c]] += raise * eigen.eigenvectors()(r, k) * eigen.eigenvectors()(c, k);
  }
  has_more_ = true;
}

// What a step's forces do to the nodes, to all squares over them.
void Patch::add_nodes_give(std::span<const NodeGive> give) {
  std::ranges::fill(nodes_give_, 0.0);
  for (const auto& [i, j, block] : give)
    nodes_give_[i * kMaxNodes + j] = nodes_give_[j * kMaxNodes + i] = normal_.dot(block * normal_);
  const int n = grid_.size();
  for (const int p : rows_) {
    fill_at_foot(foot(p), nodes_give_);
    for (const int q : rows_) {
      if (q > p) break;
      const double sum = at_foot(foot(q));
      compliance_[p * n + q] += sum;
      if (q < p) compliance_[q * n + p] += sum;
    }
  }
}

// What a force on a foot does to each node, by what it does from node to node.
void Patch::fill_at_foot(const Foot& f, const std::vector<double>& between_nodes) {
  const double* const row[] = {&between_nodes[f.local[0] * kMaxNodes], &between_nodes[f.local[1] * kMaxNodes],
                               &between_nodes[f.local[2] * kMaxNodes]};
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    at_nodes_[i] = f.weights[0] * row[0][i] + f.weights[1] * row[1][i] + f.weights[2] * row[2][i];
}

double Patch::at_foot(const Foot& f) const {
  return f.weights[0] * at_nodes_[f.local[0]] + f.weights[1] * at_nodes_[f.local[1]] +
         f.weights[2] * at_nodes_[f.local[2]];
}

}  // namespace palpate

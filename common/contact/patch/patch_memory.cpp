#include "common/contact/patch/patch_memory.hpp"

#include <algorithm>
#include <cmath>

#include "common/contact/patch/patch.hpp"

namespace palpate {
namespace {

using Eigen::Vector2d;

constexpr double kMin = 1e-15;  // [m] what is smaller is zero

int square_at(const PatchGrid& grid, const Vector2d& at) {
  for (int p = 0; p < grid.size(); ++p)
    if ((grid.middle(p) - at).norm() < 0.5 * grid.edge()) return p;
  return -1;
}

}  // namespace

PatchMemory::PatchMemory(const PatchGrid& grid, const CreepStep& step)
    : step_(step), edge_(grid.edge()), dent_(grid.size(), 0.0), shifted_(grid.size(), 0.0) {
  const Vector2d x = edge_ * Vector2d::UnitX(), y = edge_ * Vector2d::UnitY();
  for (int p = 0; p < grid.size(); ++p) {
    const Vector2d& at = grid.middle(p);
    beside_.push_back(
        {square_at(grid, at + x), square_at(grid, at - x), square_at(grid, at + y), square_at(grid, at - y)});
  }
  for (Term& term : terms()) term.dent.resize(grid.size());
  forget();
}

Eigen::Vector3d PatchMemory::bent() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < step_.terms().size(); ++k) sum += step_.terms()[k].gain * terms_[k].bent;
  return sum;
}

// With d(t) the elastic displacement, s follows it as in CreepStep; kept is keep s + old d.
void PatchMemory::follow(std::span<const double> dent, const Eigen::Vector3d& bent) {
  for (std::size_t k = 0; k < terms().size(); ++k) {
    const CreepStep::Term& step = step_.terms()[k];
    const double gained = step.keep * step.fresh + step.old;
    Term& term = terms_[k];
    for (std::size_t p = 0; p < dent.size(); ++p) {
      term.dent[p] = step.keep * term.dent[p] + gained * dent[p];
      if (std::abs(term.dent[p]) < kMin) term.dent[p] = 0;
    }
    term.bent = step.keep * term.bent + gained * bent;
    if (term.bent.norm() < kMin) term.bent.setZero();
  }
  sum_up();
}

void PatchMemory::slip(const Vector2d& slip, double width) {
  if (slip.isZero(0)) return;
  for (Term& term : terms()) {
    for (int axis = 0; axis < 2; ++axis)
      shift(term.dent, 2 * axis + (slip[axis] > 0 ? 0 : 1), std::min(1.0, std::abs(slip[axis]) / edge_));
    term.bent *= width > 0 ? std::max(0.0, 1 - slip.norm() / width) : 0.0;
  }
  sum_up();
}

// Each square takes over a share of the tissue of the one beside it.
void PatchMemory::shift(std::vector<double>& dent, int direction, double share) {
  if (share == 0) return;
  for (std::size_t p = 0; p < dent.size(); ++p) {
    const int from = beside_[p][direction];
    shifted_[p] = (1 - share) * dent[p] + (from < 0 ? 0.0 : share * dent[from]);
  }
  std::ranges::copy(shifted_, dent.begin());
}

void PatchMemory::sum_up() {
  std::ranges::fill(dent_, 0.0);
  for (std::size_t k = 0; k < terms().size(); ++k)
    for (std::size_t p = 0; p < dent_.size(); ++p) dent_[p] += step_.terms()[k].gain * terms_[k].dent[p];
}

void PatchMemory::forget() {
  for (Term& term : terms()) {
    std::ranges::fill(term.dent, 0.0);
    term.bent.setZero();
  }
  std::ranges::fill(dent_, 0.0);
}

void PatchMemory::state(State& s) {
  for (Term& term : terms()) {
    s.all(term.dent);
    s.value(term.bent);
  }
  if (s.restoring()) sum_up();
}

}  // namespace palpate

#include "common/contact/patch/patch_grid.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double kSquaresPerRadius = 4;  // 44 squares in all
constexpr double kWidth = 0.95;          // of the radius: beyond it the sphere is too steep to press
constexpr int kStripColumns = 10;        // by PatchGrid::kStripRows; with a tip's squares 124

int squares_across() {
  return static_cast<int>(2 * kWidth * kSquaresPerRadius) + 1;
}

}  // namespace

PatchGrid::PatchGrid(double radius, double length, const HalfSpace& half_space, Feet feet, double widest)
    : radius_(radius),
      length_(length),
      edge_(std::min(radius, widest) * (strip() ? 2.0 / kStripRows : 1 / kSquaresPerRadius)),
      half_space_(half_space),
      columns_(strip() ? kStripColumns : squares_across()),
      rows_(strip() ? kStripRows : squares_across()),
      column_feet_(strip() && feet == Feet::of_columns) {
  for (int i = 0; i < columns_; ++i) {
    first_.push_back(size());
    for (int j = 0; j < rows_; ++j) {
      const double beside =
          strip() ? std::abs(across(j)) : edge_ * std::hypot(i - 0.5 * (columns_ - 1), j - 0.5 * (rows_ - 1));
      if (beside >= kWidth * std::min(radius, widest)) continue;
      cells_.push_back({i, j});
      middle_.emplace_back(edge_ * (i - 0.5 * (columns_ - 1)), across(j));
      rise_.push_back(std::sqrt(radius * radius - beside * beside));
      lean_.push_back(strip() ? Eigen::Vector2d(0, 0) : Eigen::Vector2d(middle_.back() / rise_.back()));
    }
  }
  first_.push_back(size());
  for (const Cell& p : cells_)
    for (const Cell& q : cells_) ways_.push_back(std::abs(p.column - q.column) * rows_ + std::abs(p.row - q.row));
}

PatchKernel::PatchKernel(const PatchGrid& grid)
    : grid_(grid),
      corners_((grid.columns() + 1) * (grid.rows() + 1)),
      crossed_corners_(corners_.size()),
      pressed_(grid.columns() * (2 * grid.rows() - 1)),
      sheared_(grid.columns() * grid.rows()),
      crossed_(sheared_.size()),
      leaning_(grid.strip() ? 0 : grid.size() * grid.size()),
      across_(leaning_.size()) {
  lay(grid.edge());
}

void PatchKernel::add_leaning(int p, double leans, double* row) const {
  const double *const leaning = &leaning_[p * grid_.size()], *const across = &across_[p * grid_.size()];
  for (int q = 0; q < grid_.size(); ++q) row[q] += leans * (leans * leaning[q] + across[q]);
}

void PatchKernel::lay(double length) {
  if (length == length_) return;
  length_ = length;
  const int columns = grid_.columns(), rows = grid_.rows();
  for (int i = 0; i <= columns; ++i)
    for (int j = 0; j <= rows; ++j)
      corners_[i * (rows + 1) + j] = HalfSpace::corner((i - 0.5) * length, (j - 0.5) * grid_.edge());
  const double per_force = 1 / (length * grid_.edge());
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      const HalfSpace::Corner* low = &corners_[i * (rows + 1) + j];
      const HalfSpace::Corner* high = low + rows + 1;
      const HalfSpace::Corner sum{high[1].across - high[0].across - low[1].across + low[0].across,
                                  high[1].along - high[0].along - low[1].along + low[0].along,
                                  high[1].mixed - high[0].mixed - low[1].mixed + low[0].mixed};
      double* const pressed = &pressed_[i * (2 * rows - 1) + rows - 1];
      pressed[j] = pressed[-j] = per_force * grid_.half_space().pressed(sum);
      sheared_[i * rows + j] = per_force * grid_.half_space().sheared(sum);
    }
  if (!grid_.strip()) lay_leaning();
}

void PatchKernel::lay_crossed() {
  if (crossed_length_ == length_) return;
  crossed_length_ = length_;
  const int columns = grid_.columns(), rows = grid_.rows();
  for (int i = 0; i <= columns; ++i)
    for (int j = 0; j <= rows; ++j)
      crossed_corners_[i * (rows + 1) + j] =
          grid_.half_space().crossed_corner((i - 0.5) * length_, (j - 0.5) * grid_.edge()) / (length_ * grid_.edge());
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      const Eigen::Vector2d *low = &crossed_corners_[i * (rows + 1) + j], *high = low + rows + 1;
      crossed_[i * rows + j] = high[1] - high[0] - low[1] + low[0];
    }
}

void PatchKernel::lay_leaning() {
  lay_crossed();
  for (int p = 0; p < grid_.size(); ++p)
    for (int q = 0; q < grid_.size(); ++q) {
      const Eigen::Matrix2d k = sheared(p, q);
      leaning_[p * grid_.size() + q] = grid_.lean(p).dot(k * grid_.lean(q));
      across_[p * grid_.size() + q] = crossed(p, q).dot(grid_.lean(q) - grid_.lean(p));
    }
}

const PatchGrid& PatchGrids::of(double radius, double length, PatchGrid::Feet feet) {
  const bool of_columns = length > 0 && feet == PatchGrid::Feet::of_columns;
  const auto known = std::ranges::find_if(grids_, [&](const auto& g) {
    return g->radius() == radius && g->length() == length && g->column_feet() == of_columns;
  });
  if (known != grids_.end()) return **known;
  return *grids_.emplace_back(std::make_unique<PatchGrid>(radius, length, half_space_, feet, widest_));
}

}  // namespace palpate

#pragma once
#include <Eigen/Core>
#include <limits>
#include <memory>
#include <vector>

#include "common/contact/patch/half_space.hpp"

namespace palpate {

/// The cells of a patch, in columns along its first axis and rows along its second. Under a sphere they are squares
/// about the patch's middle; under a segment rectangles along it, as long as where it lies on the tissue asks for. The
/// same for all patches of one shape on one material.
class PatchGrid {
 public:
  static constexpr int kStripRows = 8;

  enum class Feet { of_columns, of_cells };  ///< of a segment's; a sphere's cells have their own

  /// Of a sphere where `length` [m] is 0. `widest` [m]: half its width at most, however wide the part is.
  PatchGrid(double radius, double length, const HalfSpace& half_space, Feet feet = Feet::of_columns,
            double widest = std::numeric_limits<double>::infinity());

  int size() const { return static_cast<int>(cells_.size()); }
  double radius() const { return radius_; }  ///< [m] of the sphere, or about the segment
  double length() const { return length_; }  ///< [m] of the segment
  bool strip() const { return length_ > 0; }
  double edge() const { return edge_; }  ///< [m] of a square, or across a rectangle
  const HalfSpace& half_space() const { return half_space_; }

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int column(int p) const { return cells_[p].column; }
  int row(int p) const { return cells_[p].row; }
  double across(int row) const { return edge_ * (row - 0.5 * (rows_ - 1)); }  ///< [m] of a row's middle
  double rise(int p) const { return rise_[p]; }  ///< [m] of the sphere, or the axis, over it
  /// [1] By how much the sphere's outward normal leans along the two axes there, per length along the patch's own: a
  /// pressure pushes the tissue aside too. A segment's flank pushes along the patch's normal alone.
  const Eigen::Vector2d& lean(int p) const { return lean_[p]; }
  /// [m] about the patch's middle, of a sphere's square.
  const Eigen::Vector2d& middle(int p) const { return middle_[p]; }
  /// Cells stand column by column, those of one in rows that follow one another: the first of a column, and behind the
  /// last one how many there are.
  int first(int column) const { return first_[column]; }

  /// Places at which the tissue under the cells is asked for what it has beyond the half-space: each cell's own, or one
  /// for a column of rectangles.
  bool column_feet() const { return column_feet_; }
  int feet() const { return column_feet_ ? columns_ : size(); }
  int foot(int p) const { return column_feet_ ? column(p) : p; }
  int first_foot(int column) const { return column_feet_ ? column : first(column); }  ///< of a column, like first()
  /// Of cell p, for each cell q: which of columns() * rows() ways lies between them, whatever its sign.
  const int* ways_from(int p) const { return &ways_[p * cells_.size()]; }

 private:
  struct Cell {
    int column, row;
  };

  double radius_, length_, edge_;
  HalfSpace half_space_;
  int columns_, rows_;
  bool column_feet_;
  std::vector<Cell> cells_;
  std::vector<double> rise_;
  std::vector<Eigen::Vector2d> middle_, lean_;
  std::vector<int> first_;
  std::vector<int> ways_;
};

/// What the half-space makes of forces on a grid's cells.
class PatchKernel {
 public:
  explicit PatchKernel(const PatchGrid& grid);

  /// For cells of a length [m].
  void lay(double length);
  double own() const { return pressed_[grid_.rows() - 1]; }  ///< [m/N] of a cell by itself
  /// [m/N] Between a cell in row `row` and those of a column so many columns away: one entry a row.
  const double* pressed(int columns_away, int row) const {
    return &pressed_[columns_away * (2 * grid_.rows() - 1) + grid_.rows() - 1 - row];
  }
  /// Adds what leaning forces do beyond pressed(), between cell p and each cell [m/N], where they lean by a
  /// share of their own. Not of a segment.
  void add_leaning(int p, double leans, double* row) const;
  /// [m/N] At cell p into the surface, by shear on cell q. After lay_crossed().
  Eigen::Vector2d crossed(int p, int q) const {
    const Eigen::Vector2d& k = crossed_[grid_.ways_from(p)[q]];
    return {grid_.column(p) < grid_.column(q) ? -k.x() : k.x(), grid_.row(p) < grid_.row(q) ? -k.y() : k.y()};
  }
  void lay_crossed();                            ///< for the cells as they are laid
  Eigen::Matrix2d sheared(int p, int q) const {  ///< [m/N]
    Eigen::Matrix2d k = sheared_[grid_.ways_from(p)[q]];
    if ((grid_.column(p) < grid_.column(q)) != (grid_.row(p) < grid_.row(q))) k(0, 1) = k(1, 0) = -k(0, 1);
    return k;
  }

 private:
  void lay_leaning();

  const PatchGrid& grid_;
  double length_ = 0, crossed_length_ = 0;
  std::vector<HalfSpace::Corner> corners_;
  std::vector<Eigen::Vector2d> crossed_corners_;
  std::vector<double> pressed_;           ///< by the columns between them, and by the rows from - to +
  std::vector<Eigen::Matrix2d> sheared_;  ///< by the way between them
  std::vector<Eigen::Vector2d> crossed_;  ///< likewise
  std::vector<double> leaning_, across_;  ///< [m/N] row by row of cells, by the square of what they lean, and by that
};

/// One grid for each shape, on one material.
class PatchGrids {
 public:
  /// `widest` [m]: as PatchGrid takes it.
  PatchGrids(const HalfSpace& half_space, double widest) : half_space_(half_space), widest_(widest) {}
  /// Stays where it is while this object lives.
  const PatchGrid& of(double radius, double length = 0, PatchGrid::Feet feet = PatchGrid::Feet::of_columns);

 private:
  HalfSpace half_space_;
  double widest_;
  std::vector<std::unique_ptr<PatchGrid>> grids_;
};

}  // namespace palpate

#include "tools/organ/distance_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr float kFar = 1e20f;

/// Calls work(first index, stride) for every line of the grid along an axis, neighbours in memory one after the other.
template <class Work>
void along_lines(const GridShape& shape, int axis, const Work& work) {
  const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(shape.count[0]),
                                          static_cast<std::size_t>(shape.count[0]) * shape.count[1]};
  const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
  for (int j = 0; j < shape.count[b]; ++j)
    for (int i = 0; i < shape.count[a]; ++i) work(i * stride[a] + j * stride[b], stride[axis]);
}

/// Lower envelope of parabolas (Felzenszwalb and Huttenlocher, Theory of Computing 8, 2012): squared distance along one
/// line from what is 0 in `line`.
class LineDistance {
 public:
  explicit LineDistance(int count) : centre_(count), border_(count + 1), result_(count) {}

  void apply(std::vector<float>& line, double spacing) {
    const int n = static_cast<int>(line.size());
    const double square = spacing * spacing;
    int last = -1;
    for (int q = 0; q < n; ++q) {
      if (line[q] >= kFar) continue;
      double from = -std::numeric_limits<double>::infinity();
      while (last >= 0) {
        const int p = centre_[last];
        from = (line[q] - line[p]) / (2 * square * (q - p)) + 0.5 * (q + p);
        if (from > border_[last]) break;
        --last;
      }
      if (last < 0) from = -std::numeric_limits<double>::infinity();
      centre_[++last] = q;
      border_[last] = from;
    }
    if (last < 0) return;
    for (int q = 0, k = 0; q < n; ++q) {
      while (k < last && border_[k + 1] < q) ++k;
      const double steps = q - centre_[k];
      result_[q] = static_cast<float>(steps * steps * square + line[centre_[k]]);
    }
    line.swap(result_);
  }

 private:
  std::vector<int> centre_;
  std::vector<double> border_;
  std::vector<float> result_;
};

/// [m] from the nearest value that is `side`.
std::vector<float> distance_from(const GridShape& shape, const std::vector<char>& inside, bool side) {
  std::vector<float> squares(shape.size());
  for (std::size_t i = 0; i < squares.size(); ++i) squares[i] = (inside[i] != 0) == side ? 0 : kFar;
  for (int axis = 0; axis < 3; ++axis) {
    LineDistance lines(shape.count[axis]);
    std::vector<float> line(shape.count[axis]);
    along_lines(shape, axis, [&](std::size_t first, std::size_t stride) {
      for (std::size_t i = 0; i < line.size(); ++i) line[i] = squares[first + i * stride];
      lines.apply(line, shape.spacing[axis]);
      for (std::size_t i = 0; i < line.size(); ++i) squares[first + i * stride] = line[i];
    });
  }
  for (float& s : squares) s = std::sqrt(s);
  return squares;
}

}  // namespace

double ScalarGrid::at(const Eigen::Vector3d& x) const {
  std::array<int, 3> low;
  Eigen::Vector3d part;
  for (int a = 0; a < 3; ++a) {
    const double place = std::clamp((x[a] - shape.origin[a]) / shape.spacing[a], 0.0, shape.count[a] - 1.0);
    low[a] = std::min(static_cast<int>(place), shape.count[a] - 2);
    part[a] = place - low[a];
  }
  const std::size_t row = shape.count[0], layer = row * shape.count[1];
  const float* v = value.data() + shape.index(low[0], low[1], low[2]);
  const auto along_x = [&](std::size_t shift) { return v[shift] + part[0] * (v[shift + 1] - v[shift]); };
  const auto along_y = [&](std::size_t shift) {
    const double first = along_x(shift);
    return first + part[1] * (along_x(shift + row) - first);
  };
  const double first = along_y(0);
  return first + part[2] * (along_y(layer) - first);
}

DistanceGrid distance_to_border(const GridShape& shape, const std::vector<char>& inside) {
  const float half = static_cast<float>(0.5 * shape.spacing.minCoeff());
  DistanceGrid grid{shape, distance_from(shape, inside, true)};
  const std::vector<float> within = distance_from(shape, inside, false);
  for (std::size_t i = 0; i < within.size(); ++i) grid.value[i] = inside[i] ? half - within[i] : grid.value[i] - half;
  return grid;
}

void smooth(ScalarGrid& grid, const Eigen::Vector3d& width) {
  for (int axis = 0; axis < 3; ++axis) {
    const double deviation = width[axis] / grid.shape.spacing[axis];
    const int reach = static_cast<int>(std::ceil(3 * deviation)), count = grid.shape.count[axis];
    std::vector<double> weight(reach + 1);
    double sum = 0;
    for (int i = 0; i <= reach; ++i) {
      weight[i] = std::exp(-0.5 * i * i / (deviation * deviation));
      sum += i == 0 ? weight[i] : 2 * weight[i];
    }
    std::vector<double> line(count + 2 * reach);
    along_lines(grid.shape, axis, [&](std::size_t first, std::size_t stride) {
      for (int i = -reach; i < count + reach; ++i)
        line[i + reach] = grid.value[first + std::clamp(i, 0, count - 1) * stride];
      for (int i = 0; i < count; ++i) {
        double value = weight[0] * line[i + reach];
        for (int w = 1; w <= reach; ++w) value += weight[w] * (line[i + reach - w] + line[i + reach + w]);
        grid.value[first + i * stride] = static_cast<float>(value / sum);
      }
    });
  }
}

double volume_below(const DistanceGrid& grid, double level) {
  const double width = grid.shape.spacing.mean();
  double cells = 0;
  for (const float d : grid.value) cells += std::clamp(0.5 - (d - level) / width, 0.0, 1.0);
  return cells * grid.shape.spacing.prod();
}

}  // namespace palpate

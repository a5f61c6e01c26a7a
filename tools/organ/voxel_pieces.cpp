#include "tools/organ/voxel_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {
namespace {

struct Piece {
  std::size_t first = 0, voxels = 0;
  bool at_rim = false;  ///< of the grid
};

using Step = std::array<int, 3>;

/// From a voxel to those that share a face with it, or an edge or a corner too.
std::vector<Step> steps_to_neighbours(bool through_faces_alone) {
  std::vector<Step> steps;
  for (int k = -1; k <= 1; ++k)
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i)
        if (const int apart = i * i + j * j + k * k; apart == 1 || (apart > 1 && !through_faces_alone))
          steps.push_back({i, j, k});
  return steps;
}

/// Numbers the pieces of voxels that are `value`, from 1; 0: the others.
std::vector<int> pieces_of(const GridShape& shape, const std::vector<char>& inside, bool value,
                           std::vector<Piece>& pieces, bool through_faces_alone = true) {
  const std::vector<Step> steps = steps_to_neighbours(through_faces_alone);
  std::vector<int> number(shape.size(), 0);
  std::vector<std::size_t> queue;
  for (std::size_t start = 0; start < number.size(); ++start) {
    if ((inside[start] != 0) != value || number[start] != 0) continue;
    pieces.push_back({start});
    const int piece = static_cast<int>(pieces.size());
    number[start] = piece;
    queue.assign(1, start);
    while (!queue.empty()) {
      const Step at = shape.voxel_of(queue.back());
      queue.pop_back();
      ++pieces.back().voxels;
      for (const Step& step : steps) {
        const Step to{at[0] + step[0], at[1] + step[1], at[2] + step[2]};
        bool in_grid = true;
        for (int a = 0; a < 3; ++a) in_grid = in_grid && to[a] >= 0 && to[a] < shape.count[a];
        pieces.back().at_rim = pieces.back().at_rim || !in_grid;
        if (!in_grid) continue;
        const std::size_t next = shape.index(to[0], to[1], to[2]);
        if ((inside[next] != 0) != value || number[next] != 0) continue;
        number[next] = piece;
        queue.push_back(next);
      }
    }
  }
  return number;
}

struct Count {
  int apart, joined;  ///< pieces of voxels that hang together through faces alone, or through edges and corners too
};

Count count_pieces(const GridShape& shape, const std::vector<char>& inside, bool value) {
  std::vector<Piece> apart, joined;
  pieces_of(shape, inside, value, apart);
  if (apart.size() > 1) pieces_of(shape, inside, value, joined, false);
  return {static_cast<int>(apart.size()), static_cast<int>((joined.empty() ? apart : joined).size())};
}

/// Euler's number of voxels that are `value` and hang together through faces: voxels less pairs, plus squares of four,
/// less cubes of eight.
int euler_number(const GridShape& shape, const std::vector<char>& inside, bool value) {
  const auto is = [&](int i, int j, int k) {
    return i >= 0 && j >= 0 && k >= 0 && (inside[shape.index(i, j, k)] != 0) == value;
  };
  int euler = 0;
  for (int k = 0; k < shape.count[2]; ++k)
    for (int j = 0; j < shape.count[1]; ++j)
      for (int i = 0; i < shape.count[0]; ++i) {
        if (!is(i, j, k)) continue;
        const bool x = is(i - 1, j, k), y = is(i, j - 1, k), z = is(i, j, k - 1);
        const bool xy = x && y && is(i - 1, j - 1, k), yz = y && z && is(i, j - 1, k - 1),
                   zx = z && x && is(i - 1, j, k - 1);
        const bool cube = xy && yz && zx && is(i - 1, j - 1, k - 1);
        euler += 1 - x - y - z + xy + yz + zx - cube;
      }
  return euler;
}

Finding found_piece(const GridShape& shape, const Piece& piece, const std::string& name, const char* what,
                    const char* several, const char* done) {
  return {fmt::format("'{}': a {} of {} voxels ({:.3g} ml)", name, what, piece.voxels,
                      1e6 * static_cast<double>(piece.voxels) * shape.spacing.prod()),
          done,
          {shape.place_of(piece.first)},
          fmt::format("{} of '{}'", several, name)};
}

}  // namespace

void keep_largest_piece(const GridShape& shape, std::vector<char>& inside, const std::string& name,
                        std::vector<Finding>& findings) {
  std::vector<Piece> pieces;
  const std::vector<int> number = pieces_of(shape, inside, true, pieces);
  const auto largest = static_cast<int>(std::ranges::max_element(pieces, {}, &Piece::voxels) - pieces.begin()) + 1;
  for (std::size_t p = 0; p < pieces.size(); ++p)
    if (static_cast<int>(p) + 1 != largest)
      findings.push_back(found_piece(shape, pieces[p], name, "stray piece", "stray pieces", "left out"));
  for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = number[i] == largest;
}

void keep_pieces_with(const GridShape& shape, std::vector<char>& inside, const std::vector<std::size_t>& seeds) {
  std::vector<Piece> pieces;
  const std::vector<int> number = pieces_of(shape, inside, true, pieces);
  std::vector<char> keep(pieces.size() + 1, 0);
  for (const std::size_t seed : seeds) keep[number[seed]] = number[seed] > 0;
  for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = keep[number[i]];
}

void fill_cavities(const GridShape& shape, std::vector<char>& inside, const std::vector<char>& other, double largest,
                   const std::string& name, std::vector<Finding>& findings) {
  std::vector<Piece> pieces;
  const std::vector<int> number = pieces_of(shape, inside, false, pieces);
  std::vector<char> fill(pieces.size() + 1, 0);
  const auto most = largest * static_cast<double>(std::ranges::count(inside, 1));
  for (std::size_t p = 0; p < pieces.size(); ++p) fill[p + 1] = !pieces[p].at_rim;
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (other[i] && !inside[i]) fill[number[i]] = 0;
  for (std::size_t p = 0; p < pieces.size(); ++p)
    if (fill[p + 1]) {
      fill[p + 1] = static_cast<double>(pieces[p].voxels) <= most;
      findings.push_back(found_piece(shape, pieces[p], name, "cavity", "cavities", fill[p + 1] ? "filled" : "kept"));
    }
  for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = inside[i] || fill[number[i]];
}

bool VoxelTopology::allows(const Topology& body) const {
  const auto between = [](int value, int a, int b) { return value >= std::min(a, b) && value <= std::max(a, b); };
  return between(body.surfaces, apart.surfaces, joined.surfaces) &&
         between(body.handles, apart.handles, joined.handles);
}

VoxelTopology topology_of(const GridShape& shape, const std::vector<char>& inside) {
  const Count pieces = count_pieces(shape, inside, true), gaps = count_pieces(shape, inside, false);
  const int around = 1;  // of the gaps, and Euler's number of the whole grid
  const int apart = pieces.apart + gaps.joined - around, joined = pieces.joined + gaps.apart - around;
  return {{apart, apart - euler_number(shape, inside, true)},
          {joined, joined - (euler_number(shape, inside, false) - around)},
          pieces.apart,
          pieces.joined};
}

}  // namespace palpate

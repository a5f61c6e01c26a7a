#include "tools/organ/voxel_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {
namespace {

struct Piece {
  std::size_t first = 0, voxels = 0;
  bool at_rim = false;  ///< of the grid
};

/// Numbers the pieces of voxels that are `value`, from 1; 0: the others.
std::vector<int> pieces_of(const GridShape& shape, const std::vector<char>& inside, bool value,
                           std::vector<Piece>& pieces) {
  std::vector<int> number(shape.size(), 0);
  std::vector<std::size_t> queue;
  const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(shape.count[0]),
                                          static_cast<std::size_t>(shape.count[0]) * shape.count[1]};
  for (std::size_t start = 0; start < number.size(); ++start) {
    if ((inside[start] != 0) != value || number[start] != 0) continue;
    pieces.push_back({start});
    const int piece = static_cast<int>(pieces.size());
    number[start] = piece;
    queue.assign(1, start);
    while (!queue.empty()) {
      const std::size_t at = queue.back();
      queue.pop_back();
      ++pieces.back().voxels;
      for (int a = 0; a < 3; ++a) {
        const auto place = static_cast<int>(at / stride[a] % shape.count[a]);
        for (const int way : {-1, 1}) {
          if (place + way < 0 || place + way >= shape.count[a]) {
            pieces.back().at_rim = true;
            continue;
          }
          const std::size_t next = way > 0 ? at + stride[a] : at - stride[a];
          if ((inside[next] != 0) != value || number[next] != 0) continue;
          number[next] = piece;
          queue.push_back(next);
        }
      }
    }
  }
  return number;
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

Topology topology_of(const GridShape& shape, const std::vector<char>& inside) {
  std::vector<Piece> pieces, gaps;
  pieces_of(shape, inside, true, pieces);
  pieces_of(shape, inside, false, gaps);
  const auto surfaces = static_cast<int>(pieces.size() + std::ranges::count(gaps, false, &Piece::at_rim));
  const std::size_t row = shape.count[0], layer = row * shape.count[1];
  long euler = 0;  // voxels less pairs, plus squares of four, less cubes of eight
  for (std::size_t i = layer + row + 1; i < inside.size(); ++i) {
    if (!inside[i]) continue;
    const bool x = inside[i - 1], y = inside[i - row], z = inside[i - layer];
    const bool xy = x && y && inside[i - row - 1], yz = y && z && inside[i - layer - row],
               zx = z && x && inside[i - layer - 1];
    const bool cube = xy && yz && zx && inside[i - layer - row - 1];
    euler += 1 - x - y - z + xy + yz + zx - cube;
  }
  return {surfaces, static_cast<int>(surfaces - euler)};
}

}  // namespace palpate

#include "tools/organ/voxel_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/organ/surface_shells.hpp"

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

std::string say_piece(const GridShape& shape, const Piece& piece) {
  const int row = shape.count[0], layer = row * shape.count[1];
  const auto at = static_cast<long>(piece.first);
  return fmt::format("{} voxels ({:.3g} ml) at {}", piece.voxels, 1e6 * piece.voxels * shape.spacing.prod(),
                     place_in_mm(shape.place(static_cast<int>(at % row), static_cast<int>(at / row % shape.count[1]),
                                             static_cast<int>(at / layer))));
}

}  // namespace

void keep_largest_piece(const GridShape& shape, std::vector<char>& inside, const std::string& name,
                        std::vector<std::string>& findings) {
  std::vector<Piece> pieces;
  const std::vector<int> number = pieces_of(shape, inside, true, pieces);
  const auto largest = static_cast<int>(std::ranges::max_element(pieces, {}, &Piece::voxels) - pieces.begin()) + 1;
  for (std::size_t p = 0; p < pieces.size(); ++p)
    if (static_cast<int>(p) + 1 != largest)
      findings.push_back(fmt::format("'{}': a stray piece of {}: left out", name, say_piece(shape, pieces[p])));
  for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = number[i] == largest;
}

void keep_pieces_with(const GridShape& shape, std::vector<char>& inside, const std::vector<std::size_t>& seeds) {
  std::vector<Piece> pieces;
  const std::vector<int> number = pieces_of(shape, inside, true, pieces);
  std::vector<char> keep(pieces.size() + 1, 0);
  for (const std::size_t seed : seeds) keep[number[seed]] = number[seed] > 0;
  for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = keep[number[i]];
}

void fill_cavities(const GridShape& shape, std::vector<char>& inside, const std::vector<char>& other,
                   const std::string& name, std::vector<std::string>& findings) {
  std::vector<Piece> pieces;
  const std::vector<int> number = pieces_of(shape, inside, false, pieces);
  std::vector<char> fill(pieces.size() + 1, 0);
  for (std::size_t p = 0; p < pieces.size(); ++p) fill[p + 1] = !pieces[p].at_rim;
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (other[i] && !inside[i]) fill[number[i]] = 0;
  for (std::size_t p = 0; p < pieces.size(); ++p)
    if (fill[p + 1]) findings.push_back(fmt::format("'{}': a cavity of {}: filled", name, say_piece(shape, pieces[p])));
  for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = inside[i] || fill[number[i]];
}

}  // namespace palpate

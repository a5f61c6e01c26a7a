#include "common/archive/archive_presses.hpp"

#include <algorithm>
#include <utility>

#include "common/archive/rows.hpp"

namespace palpate {
namespace {

using Pairs = std::vector<PressedPlace::Pair>;

std::vector<double> flatten_pairs(const Pairs& pairs) {
  return flatten(pairs, 2, [](const auto& row, std::size_t c) { return row[c]; });
}

/// Takes so many from the front.
Pairs take(Pairs& from, std::int32_t count) {
  const auto end = from.begin() + std::clamp<std::ptrdiff_t>(count, 0, static_cast<std::ptrdiff_t>(from.size()));
  Pairs taken(from.begin(), end);
  from.erase(from.begin(), end);
  return taken;
}

bool ascends(const Pairs& pairs) {
  double before = 0;
  return std::ranges::all_of(pairs, [&](const auto& pair) { return pair[0] > std::exchange(before, pair[0]); });
}

}  // namespace

void write_presses(Hdf5Writer& file, const Archive& archive) {
  std::vector<Eigen::Vector3d> place;
  std::vector<double> depth;
  std::vector<std::int32_t> count;
  Pairs force, radial;
  for (const PressedPlace& p : archive.presses) {
    place.push_back(p.at);
    depth.push_back(p.depth);
    count.insert(count.end(), {static_cast<std::int32_t>(p.force.size()), static_cast<std::int32_t>(p.radial.size())});
    force.insert(force.end(), p.force.begin(), p.force.end());
    radial.insert(radial.end(), p.radial.begin(), p.radial.end());
  }
  file.dataset({"presses/place", "m", "where a ball was pressed in"},
               flatten(place, 3, [](const auto& row, std::size_t c) { return double{row[c]}; }), 3);
  file.dataset({"presses/depth", "m", "deepest press at each place"}, depth);
  file.dataset({"presses/count", "1", "rows of presses/force and of presses/radial of each place"}, count, 2);
  file.dataset({"presses/force", "N", "force along the press: linear, neo-Hookean; depth by depth"},
               flatten_pairs(force), 2);
  file.dataset({"presses/radial", "m", "displacement across the press: linear, neo-Hookean; classes of nodes"},
               flatten_pairs(radial), 2);
}

void read_presses(const Hdf5Reader& file, Archive& archive) {
  const auto place = rows_of<Eigen::Vector3d>(3, file.doubles("presses/place"));
  auto depth = file.doubles("presses/depth", kAboveZero);
  auto count = rows_of<std::array<std::int32_t, 2>>(2, file.integers("presses/count"));
  auto force = rows_of<PressedPlace::Pair>(2, file.doubles("presses/force"));
  auto radial = rows_of<PressedPlace::Pair>(2, file.doubles("presses/radial"));
  depth.resize(place.size());
  count.resize(place.size());
  for (std::size_t i = 0; i < place.size(); ++i)
    archive.presses.push_back({place[i], depth[i], take(force, count[i][0]), take(radial, count[i][1])});
}

bool presses_fit(const Archive& archive) {
  return std::ranges::all_of(archive.presses, [](const PressedPlace& p) {
    return p.depth > 0 && !p.force.empty() && ascends(p.force) && ascends(p.radial);
  });
}

std::size_t presses_payload_bytes(const Archive& archive) {
  std::size_t doubles = 0;
  for (const PressedPlace& p : archive.presses) doubles += 5 + 2 * (p.force.size() + p.radial.size());
  return sizeof(double) * doubles;
}

}  // namespace palpate

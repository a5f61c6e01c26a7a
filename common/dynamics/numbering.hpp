#pragma once
#include <array>
#include <span>
#include <vector>

namespace palpate {

/// Which items belong to each of several things, in one array.
struct Incidence {
  std::vector<int> begin;  ///< size count + 1
  std::vector<int> item;

  std::span<const int> of(int n) const { return {item.data() + begin[n], item.data() + begin[n + 1]}; }
};

/// For each of `count` things, which of the tuples name it; ascending.
template <class Tuples>
Incidence incidence(const Tuples& tuples, int count) {
  Incidence found{std::vector<int>(count + 1, 0), {}};
  for (const auto& tuple : tuples)
    for (int n : tuple) ++found.begin[n + 1];
  for (int n = 0; n < count; ++n) found.begin[n + 1] += found.begin[n];
  found.item.resize(found.begin[count]);
  std::vector<int> at(found.begin.begin(), found.begin.end() - 1);
  for (int t = 0; t < static_cast<int>(tuples.size()); ++t)
    for (int n : tuples[t]) found.item[at[n]++] = t;
  return found;
}

/// Reverse Cuthill-McKee: neighbours get near numbers. Returns the new number of each node; nodes without an
/// edge come last.
std::vector<int> number_for_locality(std::span<const std::array<int, 2>> edges, int nodes);

}  // namespace palpate

#include "common/archive/fits.hpp"

namespace palpate {

bool is_packed_compliance(std::span<const double> triangle, std::size_t n) {
  constexpr double kRounding = 1 + 1e-6;
  if (triangle.size() != n * (n + 1) / 2) return false;
  std::vector<double> diagonal;
  for (std::size_t i = 0, end = 0; i < n; ++i) {
    const auto row = triangle.subspan(end, i + 1);
    end += i + 1;
    if (!(row[i] > 0)) return false;
    diagonal.push_back(row[i]);
    for (std::size_t j = 0; j < i; ++j)
      if (!(row[j] * row[j] <= kRounding * diagonal[i] * diagonal[j])) return false;
  }
  return true;
}

}  // namespace palpate

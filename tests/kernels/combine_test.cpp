#include <cmath>
#include <random>

#include "tests/kernels/all_paths.hpp"

namespace palpate::kernels {
namespace {

using Combine = EveryPath;

/// `count` columns at odd places of one buffer, with their weights; deterministic.
template <class T>
struct Data {
  Data(int count, std::ptrdiff_t rows, int shift) : storage((rows + shift) * count + 1), weights(count) {
    std::mt19937 random(static_cast<unsigned>(count * 7919 + rows));
    std::uniform_real_distribution<T> uniform(-1, 1);
    for (T& x : storage) x = uniform(random);
    for (T& x : weights) x = uniform(random);
    for (int c = 0; c < count; ++c) columns.push_back(storage.data() + 1 + c * (rows + shift));
  }

  long double sum(std::ptrdiff_t row) const {
    long double total = 0;
    for (std::size_t c = 0; c < columns.size(); ++c) total += static_cast<long double>(weights[c]) * columns[c][row];
    return total;
  }

  std::vector<T> storage, weights;
  std::vector<const T*> columns;
};

constexpr int kCounts[] = {0, 1, 2, 3, 7, 8, 9, 10, 12, 16, 27, 192};
constexpr int kRows[] = {0, 1, 3, 5, 8, 15, 16, 17, 31, 100, 1563};

template <class T, class Kernel>
void expect_sums(Kernel kernel, double epsilon) {
  for (const int count : kCounts)
    for (const int rows : kRows) {
      const Data<T> data(count, rows, count % 5);
      const T untouched = T(77);
      std::vector<T> out(rows + 16, untouched);
      kernel(data.columns.data(), data.weights.data(), count, rows, out.data());
      for (int i = 0; i < rows; ++i)
        ASSERT_NEAR(out[i], static_cast<double>(data.sum(i)), epsilon * (count + 1)) << count << "x" << rows;
      for (int i = rows; i < rows + 16; ++i) ASSERT_EQ(out[i], untouched) << "written beyond the rows";
    }
}

TEST_P(Combine, SinglePrecisionEqualsThePlainSum) {
  expect_sums<float>(table().combine_f, 6e-8);
}

TEST_P(Combine, DoublePrecisionEqualsThePlainSum) {
  expect_sums<double>(table().combine_d, 2e-16);
}

TEST_P(Combine, ListedNodesEqualTheSameRowsOfTheWhole) {
  const std::vector<int> nodes = {0, 5, 3, 99, 3, 17};
  for (const int count : kCounts) {
    const Data<double> data(count, 300, 1);
    std::vector<double> out(3 * nodes.size() + 1, 77);
    const int node_count = static_cast<int>(nodes.size());
    table().combine_nodes_d(data.columns.data(), data.weights.data(), count, nodes.data(), node_count, out.data());
    for (int i = 0; i < 3 * node_count; ++i) {
      const double sum = static_cast<double>(data.sum(3 * nodes[i / 3] + i % 3));
      ASSERT_NEAR(out[i], sum, 2e-16 * (count + 1)) << count << " columns";
    }
    ASSERT_EQ(out.back(), 77);
  }
}

TEST_P(Combine, SameInputGivesTheSameBits) {
  const Data<float> data(192, 1563, 5);
  std::vector<float> first(1563), second(1563, 1);
  table().combine_f(data.columns.data(), data.weights.data(), 192, 1563, first.data());
  table().combine_f(data.columns.data(), data.weights.data(), 192, 1563, second.data());
  EXPECT_EQ(first, second);
}

INSTANTIATE_TEST_SUITE_P(Path, Combine, ::testing::ValuesIn(available()), path_name);

}  // namespace
}  // namespace palpate::kernels

#include "common/archive/load_sum.hpp"

#include <algorithm>
#include <numeric>

#include "common/kernels/kernels.hpp"

namespace palpate {
namespace {

constexpr int kWholeColumnsFrom = 6;  // part of the row nodes, one in so many, from which whole columns are read

void combine(std::span<const double* const> columns, const double* coefficients, std::size_t rows, double* out) {
  kernels::active().combine_d(columns.data(), coefficients, static_cast<int>(columns.size()),
                              static_cast<std::ptrdiff_t>(rows), out);
}
void combine(std::span<const float* const> columns, const float* coefficients, std::size_t rows, float* out) {
  kernels::active().combine_f(columns.data(), coefficients, static_cast<int>(columns.size()),
                              static_cast<std::ptrdiff_t>(rows), out);
}

}  // namespace

template <class Scalar>
void LoadSum<Scalar>::ByLeaf::clear() {
  for (const int leaf : used) first[leaf] = -1;
  used.clear();
  next.clear();
}

template <class Scalar>
void LoadSum<Scalar>::ByLeaf::put(int leaf, int number) {
  if (first[leaf] < 0) used.push_back(leaf);
  next.resize(number + 1);
  next[number] = first[leaf];
  first[leaf] = number;
}

template <class Scalar>
LoadSum<Scalar>::LoadSum(const Compliance<Scalar>& compliance, std::size_t foreseen) : compliance_(compliance) {
  const std::size_t rows = compliance.row_nodes();
  const CompressedCompliance* compressed = compliance.compressed();
  if (!compressed) {
    columns_.reserve(3 * foreseen);
    coefficients_.reserve(3 * foreseen);
    whole_.assign(3 * rows, 0);
    return;
  }
  loads_.reserve(foreseen);
  for (ByLeaf* list : {&loaded_, &moved_}) {
    list->first.assign(compressed->leaves(), -1);
    list->used.reserve(compressed->leaves());
  }
  loaded_.next.reserve(foreseen);
  moved_.next.reserve(rows);
  places_.reserve(rows);
  all_.resize(rows);
  std::iota(all_.begin(), all_.end(), 0);
  shares_.assign(compressed->max_rank(), 0);
}

template <class Scalar>
void LoadSum<Scalar>::clear() {
  columns_.clear();
  coefficients_.clear();
  loads_.clear();
  loaded_.clear();
}

template <class Scalar>
void LoadSum<Scalar>::add(int node, const Vector3& force) {
  if (node >= compliance_.column_nodes()) return;
  if (const CompressedCompliance* compressed = compliance_.compressed()) {
    const int place = compressed->place(node);
    loaded_.put(compressed->leaf(place), static_cast<int>(loads_.size()));
    loads_.push_back({place, static_cast<Scalar>(compressed->scale()) * force});
    return;
  }
  for (int axis = 0; axis < 3; ++axis) {
    columns_.push_back(compliance_.column(node, axis));
    coefficients_.push_back(force[axis]);
  }
}

template <class Scalar>
void LoadSum<Scalar>::everywhere(std::span<Scalar> displacement) {
  if (compliance_.compressed())
    compressed_at(all_, displacement);
  else
    combine(columns_, coefficients_.data(), displacement.size(), displacement.data());
}

template <class Scalar>
void LoadSum<Scalar>::at(std::span<const int> nodes, std::span<Scalar> displacement) {
  if (compliance_.compressed())
    compressed_at(nodes, displacement);
  else
    dense_at(nodes, displacement);
}

template <class Scalar>
void LoadSum<Scalar>::dense_at(std::span<const int> nodes, std::span<Scalar> displacement) {
  if constexpr (std::is_same_v<Scalar, double>)
    // Reading whole columns beats picking from them once a good part of the nodes is asked for.
    if (nodes.size() * kWholeColumnsFrom < static_cast<std::size_t>(compliance_.row_nodes())) {
      kernels::active().combine_nodes_d(columns_.data(), coefficients_.data(), static_cast<int>(columns_.size()),
                                        nodes.data(), static_cast<int>(nodes.size()), displacement.data());
      return;
    }
  combine(columns_, coefficients_.data(), whole_.size(), whole_.data());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    std::copy_n(whole_.data() + 3 * nodes[i], 3, displacement.data() + 3 * i);
}

template <class Scalar>
void LoadSum<Scalar>::compressed_at(std::span<const int> nodes, std::span<Scalar> displacement) {
  const CompressedCompliance& compressed = *compliance_.compressed();
  std::ranges::fill(displacement, Scalar{0});
  moved_.clear();
  places_.resize(nodes.size());
  for (int i = 0; i < static_cast<int>(nodes.size()); ++i) {
    places_[i] = compressed.place(nodes[i]);
    if (places_[i] >= 0) moved_.put(compressed.leaf(places_[i]), i);
  }
  for (const int moved : moved_.used)
    for (const int loaded : loaded_.used) add_tile(moved, loaded, displacement);
}

template <class Scalar>
void LoadSum<Scalar>::add_tile(int moved_leaf, int loaded_leaf, std::span<Scalar> displacement) {
  using Eigen::Map;
  const CompressedCompliance::Tile tile = compliance_.compressed()->tile(moved_leaf, loaded_leaf);
  const auto at = [&](int i) { return Map<Vector3>(displacement.data() + 3 * i); };
  if (tile.block->dense()) {
    for (int l = loaded_.first[loaded_leaf]; l >= 0; l = loaded_.next[l]) {
      const Eigen::Vector3f force = loads_[l].force.template cast<float>();
      for (int i = moved_.first[moved_leaf]; i >= 0; i = moved_.next[i])
        at(i) += tile.under(places_[i], loads_[l].place, force).template cast<Scalar>();
    }
    return;
  }
  Map<Eigen::Matrix<Scalar, Eigen::Dynamic, 1>> shares(shares_.data(), tile.block->rank);
  shares.setZero();
  for (int l = loaded_.first[loaded_leaf]; l >= 0; l = loaded_.next[l]) {
    const auto factor = tile.loaded_factor(loads_[l].place);
    for (int axis = 0; axis < 3; ++axis) shares += loads_[l].force[axis] * factor.col(axis).template cast<Scalar>();
  }
  for (int i = moved_.first[moved_leaf]; i >= 0; i = moved_.next[i]) {
    const auto factor = tile.moved_factor(places_[i]);
    for (int axis = 0; axis < 3; ++axis) at(i)[axis] += factor.col(axis).template cast<Scalar>().dot(shares);
  }
}

template class LoadSum<double>;
template class LoadSum<float>;

}  // namespace palpate

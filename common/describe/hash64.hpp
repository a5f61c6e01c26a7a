#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

struct XXH3_state_s;

namespace palpate {

/// XXH3 (64 bits) of plain values, one after the other.
class Hash64 {
 public:
  Hash64();

  template <class T>
  requires std::is_arithmetic_v<T>
  void add(T value) { add_bytes(&value, sizeof value); }
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(std::span<const T> values) { add_bytes(values.data(), values.size_bytes()); }
  template <class Scalar>
  void add(const Eigen::Matrix<Scalar, 3, 1>& v) {
    add_bytes(v.data(), sizeof v);
  }
  template <class Scalar>
  void add(std::span<const Eigen::Matrix<Scalar, 3, 1>> vectors) {
    add_bytes(vectors.data(), vectors.size_bytes());
  }
  void add_bytes(const void* data, std::size_t size);
  std::uint64_t value() const;

 private:
  struct Free {
    void operator()(XXH3_state_s* state) const;
  };
  std::unique_ptr<XXH3_state_s, Free> state_;
};

}  // namespace palpate

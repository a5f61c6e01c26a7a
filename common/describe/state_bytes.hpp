#pragma once
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <vector>

/// Plain values to and from bytes, for keyframes: counts first, and nothing read beyond the end.
namespace palpate::state_bytes {

template <class T>
void put(std::vector<std::uint8_t>& bytes, std::span<const T> values) {
  const std::uint64_t count = values.size();
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof count + values.size_bytes());
  std::memcpy(bytes.data() + at, &count, sizeof count);
  if (count > 0) std::memcpy(bytes.data() + at + sizeof count, values.data(), values.size_bytes());
}

/// Takes what put() wrote off the front. Throws std::runtime_error where it is cut short.
template <class T>
std::vector<T> take(std::span<const std::uint8_t>& bytes) {
  std::uint64_t count = 0;
  if (bytes.size() < sizeof count) throw std::runtime_error("the recorded state is cut short");
  std::memcpy(&count, bytes.data(), sizeof count);
  bytes = bytes.subspan(sizeof count);
  if (count > bytes.size() / sizeof(T)) throw std::runtime_error("the recorded state is cut short");
  std::vector<T> values(count);
  if (count > 0) std::memcpy(static_cast<void*>(values.data()), bytes.data(), count * sizeof(T));
  bytes = bytes.subspan(count * sizeof(T));
  return values;
}

/// One value.
template <class T>
void put_one(std::vector<std::uint8_t>& bytes, const T& value) {
  put(bytes, std::span<const T>(&value, 1));
}
template <class T>
T take_one(std::span<const std::uint8_t>& bytes) {
  const std::vector<T> values = take<T>(bytes);
  if (values.size() != 1) throw std::runtime_error("the recorded state holds another number of values");
  return values[0];
}

}  // namespace palpate::state_bytes

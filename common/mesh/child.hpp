#pragma once
#include <functional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace palpate {

/// A child that crashed or ran out of its limits. Its message says which.
struct ChildDied : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs `work` in a forked copy of this process and returns the bytes that it returned. The copy's terminal
/// output is discarded and its processor time is limited, so a library that prints, keeps global state,
/// crashes or loops for ever on a hostile file does none of that to this process.
/// Throws std::runtime_error with the message that `work` threw (std::exception or std::string); of a crash ChildDied,
/// "the reader crashed (signal N)" and so on, in words. Call it at set-up, not while realtime threads
/// run.
std::string run_in_child(const std::function<std::string()>& work);

/// Appends plain values to a byte string, and takes them off again in the same order.
template <class T>
void put(std::string& bytes, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
T take(const std::string& bytes, std::size_t& at) {
  T value{};
  if (bytes.size() - at < sizeof value) throw std::runtime_error("the reader's answer is cut short");
  bytes.copy(reinterpret_cast<char*>(&value), sizeof value, at);
  at += sizeof value;
  return value;
}

inline void put_text(std::string& bytes, const std::string& text) {
  put(bytes, text.size());
  bytes += text;
}

inline std::string take_text(const std::string& bytes, std::size_t& at) {
  const auto size = take<std::size_t>(bytes, at);
  if (bytes.size() - at < size) throw std::runtime_error("the reader's answer is cut short");
  at += size;
  return bytes.substr(at - size, size);
}

template <class T>
void put_all(std::string& bytes, const std::vector<T>& values) {
  put<std::size_t>(bytes, values.size());
  for (const T& value : values) put(bytes, value);
}

template <class T>
std::vector<T> take_all(const std::string& bytes, std::size_t& at) {
  const auto count = take<std::size_t>(bytes, at);
  if ((bytes.size() - at) / sizeof(T) < count) throw std::runtime_error("the reader's answer is cut short");
  std::vector<T> values(count);
  for (T& value : values) value = take<T>(bytes, at);
  return values;
}

}  // namespace palpate

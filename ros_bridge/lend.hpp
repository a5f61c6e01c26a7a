#pragma once
#include <string>
#include <vector>

#include "ros_messages.h"

/// Memory of this program put into samples that are about to be written; the middleware only reads it.
namespace palpate::ros {

inline char* lend(const char* text) {
  return const_cast<char*>(text);
}
inline char* lend(const std::string& text) {
  return lend(text.c_str());
}

template <class T, class Sequence>
void lend(std::vector<T>& values, Sequence& sequence) {
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(values.size());
  sequence._buffer = values.data();
  sequence._release = false;
}

}  // namespace palpate::ros

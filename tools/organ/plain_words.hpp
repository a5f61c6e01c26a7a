#pragma once
#include <CGAL/assertions_behaviour.h>
#include <CGAL/exceptions.h>

#include <stdexcept>

namespace palpate {

/// Runs work that CGAL does; what CGAL says of itself, line numbers of its sources, reaches nobody.
/// Throws std::runtime_error(otherwise) where it gives up.
template <class Work>
auto in_plain_words(const char* otherwise, const Work& work) {
  const auto silence = [](const char*, const char*, const char*, int, const char*) {};
  CGAL::set_warning_handler(silence);
  CGAL::set_error_handler(silence);
  try {
    return work();
  } catch (const CGAL::Failure_exception&) {
    throw std::runtime_error(otherwise);
  }
}

}  // namespace palpate

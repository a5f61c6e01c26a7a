#pragma once
#include <unistd.h>

namespace palpate::testing {

/// A DDS domain of this process's own, so that tests may run side by side.
inline int test_domain() {
  return 1 + static_cast<int>(getpid() % 200);
}

}  // namespace palpate::testing

// These tests are of what the library reads, so it is asked every time: nothing can be kept below a file.
#include <cstdlib>

namespace {
[[maybe_unused]] const int nothing_is_kept = setenv("PALPATE_CACHE", "/dev/null", 1);
}

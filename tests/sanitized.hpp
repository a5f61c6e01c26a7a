#pragma once

namespace palpate::testing {

/// A build with a sanitizer is several times slower, and keeps what has been freed for a while: times and memory are
/// not the program's. The thread sanitizer has a thread of its own in every program.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#if defined(__SANITIZE_THREAD__)
inline constexpr int kSanitizerThreads = 1;
#else
inline constexpr int kSanitizerThreads = 0;
#endif

}  // namespace palpate::testing

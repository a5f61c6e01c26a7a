#pragma once
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <unordered_map>

namespace palpate {

/// How much may wait in a reader that keeps all: of each peer so much, that none takes another one's place, and of all
/// together. On any thread.
class WaitingRoom {
 public:
  static constexpr std::size_t kSamples = 16000;               ///< of all
  static constexpr std::size_t kBytes = std::size_t{1} << 30;  ///< of all

  /// `bytes`: of each peer.
  explicit WaitingRoom(std::size_t bytes) : each_(bytes) {}

  /// A sample comes, of this writer of a peer. False if there is no room for it.
  bool enter(std::uint64_t writer, std::uint64_t peer, std::size_t bytes);
  /// One that came in has been taken.
  void leave(std::uint64_t writer, std::size_t bytes);

 private:
  struct Writer {
    std::uint64_t peer = 0;  ///< as it was when the first of these came
    std::size_t samples = 0;
  };
  const std::size_t each_;
  std::mutex mutex_;
  std::size_t samples_ = 0, bytes_ = 0;
  std::unordered_map<std::uint64_t, Writer> writers_;        ///< those of whom something waits
  std::unordered_map<std::uint64_t, std::size_t> of_peers_;  ///< bytes
};

}  // namespace palpate

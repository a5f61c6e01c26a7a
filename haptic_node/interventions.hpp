#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace palpate {

/// What stood between the inputs and the hand in a run of the haptic loop, in words: each kind once for the log, and
/// what is so at present for the status.
class Interventions {
 public:
  /// Since the last look, or in all.
  struct Seen {
    std::uint32_t flags = 0;               ///< ForceFlag bits of all steps since the last look
    std::uint64_t refused_samples = 0;     ///< of devices, in all
    std::uint64_t followed = 0;            ///< steps at a bounded speed, in all
    std::uint64_t refused_models = 0;      ///< of steps to come, in all
    std::uint64_t implausible_models = 0;  ///< that cannot be of the tissue, in all
  };
  void look(const Seen& seen);

  std::vector<std::string> news() const { return news_; }  ///< what the last look saw for the first time
  const std::string& status() const { return status_; }    ///< what the last look saw, the worst of it; empty: nothing

 private:
  Seen last_;
  std::uint32_t told_ = 0;  ///< kinds, by their place in the table
  std::vector<std::string> news_;
  std::string status_;
};

}  // namespace palpate

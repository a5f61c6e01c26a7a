#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/log_format.hpp"
#include "common/scene/scene.hpp"

namespace palpate {

/// What a log proves about its haptic steps.
struct VerifyReport {
  std::uint64_t steps = 0;   ///< steps computed again
  std::uint64_t forces = 0;  ///< recorded forces that were compared, and equal bit for bit
  std::uint64_t before_keyframe =
      0;                            ///< recorded steps that come before a run's first keyframe: no state to start from
  std::uint64_t tasks = 0;          ///< recorded task records, likewise
  std::vector<std::string> gaps;    ///< places that cannot be verified, and why
  std::string mismatch;             ///< the first force that differs; empty if none does
  std::string damage;               ///< what of the file cannot be read; empty if all can
  std::optional<LogFooter> footer;  ///< with what the recorder lost; none if it did not end in order
  std::string code_path;

  bool verified() const { return mismatch.empty() && gaps.empty() && forces > 0; }
};

/// Feeds the recorded inputs of every haptic step to the haptic step, from the first keyframe of each run, on the code
/// path that made the log, and compares the forces and the records of tasks bit for bit. Throws std::runtime_error in
/// one sentence if the log cannot be verified at all: no scene, no keyframe, a code path or archive that is not here;
/// and Interrupted after a signal.
VerifyReport verify_log(const std::filesystem::path& file);
/// The same with the log's scene, whose files may be elsewhere than the log says.
VerifyReport verify_log(const std::filesystem::path& file, const Scene& scene);

}  // namespace palpate

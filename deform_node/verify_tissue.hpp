#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/scene/scene.hpp"

namespace palpate {

struct TissueReport {
  std::uint64_t ticks = 0;        ///< computed again, with the recorded hash of the state
  std::vector<std::string> gaps;  ///< sentences: what could not be computed again, and why
  std::string mismatch;           ///< first tick that led elsewhere; empty: none
};

/// Computes the recorded ticks of a log's moving tissue again, from its keyframes and the tool states that each tick
/// consumed, and requires the recorded hash of the state after each. Nothing to do for a log without moving tissue.
/// Throws std::runtime_error if the log cannot be read or an archive is not found.
TissueReport verify_tissue(const std::filesystem::path& log, const Scene& scene);

}  // namespace palpate

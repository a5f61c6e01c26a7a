#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

namespace palpate {

/// Writes the samples of a topic log into an MCAP file, messages as CDR with their types in IDL; those of one topic, or
/// of all if `topic` is empty. Times are those at which the recorder got them, since 1970. Returns how many they are.
/// Throws std::runtime_error, also where there is none, and leaves no file then.
std::uint64_t export_mcap(const std::filesystem::path& log, const std::string& topic,
                          const std::filesystem::path& file);

}  // namespace palpate

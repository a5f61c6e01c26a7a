#pragma once
#include <dds/dds.h>

#include <set>
#include <string>
#include <vector>

namespace palpate {

/// What a participant tells of itself before any message: program, its version, hash of all messages' fields, and where
/// it runs. The middleware keeps writers and readers of a topic apart whose types differ, without a word.
std::string participant_words();

/// Finds participants of this project whose messages are of another version.
class VersionWatch {
 public:
  explicit VersionWatch(dds_entity_t participant);
  ~VersionWatch();
  VersionWatch(const VersionWatch&) = delete;
  VersionWatch& operator=(const VersionWatch&) = delete;

  /// A sentence for the operator about each that has come since the last call.
  std::vector<std::string> look();

 private:
  dds_entity_t reader_;
  std::set<std::string> said_;
};

/// The sentence about a participant with these words; empty if its messages are ours, or it is of another program.
std::string version_fault(const std::string& words);

}  // namespace palpate

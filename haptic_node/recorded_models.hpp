#pragma once
#include <deque>
#include <filesystem>
#include <map>

#include "common/bus/log_reader.hpp"

namespace palpate {

/// Order in which the runs of deform nodes appear in a log.
using RunOrder = std::map<std::uint64_t, int>;

/// The local contact models of a log for one haptic run, found again by run and number in the order of the log. Reads
/// on only as far as it must: a long log's models do not fit into memory.
class RecordedModels {
 public:
  RecordedModels(const std::filesystem::path& log, RunOrder order, std::uint64_t tool_run);

  /// The model of a tool; null if the log does not hold it. What is older is forgotten.
  const LocalContactModel* find(std::uint32_t tool, std::uint64_t run, std::uint64_t seq);

 private:
  using Place = std::pair<int, std::uint64_t>;  ///< run by its order, number in it
  Place place(std::uint64_t run, std::uint64_t seq) const;

  LogReader log_;
  RunOrder order_;
  std::uint64_t tool_run_;
  std::map<std::uint32_t, std::deque<LocalContactModel>> waiting_;
  bool at_end_ = false;
};

}  // namespace palpate

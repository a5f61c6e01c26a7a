#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace palpate {

struct LogReportSettings {
  std::vector<std::string> logs;  ///< sessions to set side by side
  std::filesystem::path folder;
  std::string data;  ///< folder for the files that a log brings along; empty: none
  int pictures = 8;  ///< of each session, evenly over its time
};

/// Writes report.json, for each session course_N.csv and picture_N_K.png, N and K from 0, and index.html with all of
/// it, in a folder that has none of these from elsewhere. Returns a sentence of each thing that the page lacks.
/// `progress` is told what is done; throws std::runtime_error.
std::vector<std::string> report_logs(const LogReportSettings& settings,
                                     const std::function<void(const std::string&)>& progress);

}  // namespace palpate

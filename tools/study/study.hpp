#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/study/method.hpp"

namespace palpate::study {

struct StudyOptions {
  bool quick = false;
  std::filesystem::path references{};  ///< where they are kept; empty: in the study's folder
  std::optional<double> budget;        ///< [s]
  std::string budget_text;             ///< as it was asked for
  int jobs = 1;                        ///< settings at the same time, each in a process that `setting_alone` starts
  /// The command that settles the setting of this number alone, in the same folder.
  std::function<std::vector<std::string>(std::size_t)> setting_alone{};
  std::function<void(const std::string&)> say = [](const std::string&) {};  ///< progress, a line at a time
};

/// All methods that can serve the scene's bodies.
Methods make_methods(const Scene& scene, const StudyOptions& options);

/// The whole sweep of one scene into a folder; points that an interrupted run of the same scene and version
/// has finished are taken from there. Throws std::runtime_error where the scene itself cannot be loaded or a
/// body has no method at all.
Result run_study(const Scene& scene, const std::filesystem::path& folder, const StudyOptions& options);

/// One setting of that sweep, by its number from 0, kept in the folder for a run of the whole. Throws
/// std::runtime_error as run_study() does, and for a number that no setting has.
void run_setting(const Scene& scene, const std::filesystem::path& folder, const StudyOptions& options,
                 std::size_t setting);

/// How many settings the sweep has.
std::size_t count_settings(const Scene& scene, const StudyOptions& options);

}  // namespace palpate::study

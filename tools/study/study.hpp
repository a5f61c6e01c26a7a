#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "tools/study/method.hpp"

namespace palpate::study {

struct StudyOptions {
  bool quick = false;
  std::filesystem::path references{};  ///< where they are kept; empty: in the study's folder
  std::optional<double> budget;        ///< [s]
  std::string budget_text;             ///< as it was asked for
  std::function<void(const std::string&)> say = [](const std::string&) {};  ///< progress, a line at a time
};

/// All methods that can serve the scene's bodies.
Methods make_methods(const Scene& scene, const StudyOptions& options);

/// The whole sweep of one scene into a folder; points that an interrupted run of the same scene and version
/// has finished are taken from there. Throws std::runtime_error where the scene itself cannot be loaded or a
/// body has no method at all.
Result run_study(const Scene& scene, const std::filesystem::path& folder, const StudyOptions& options);

}  // namespace palpate::study

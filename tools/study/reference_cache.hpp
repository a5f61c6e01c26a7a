#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace palpate::study {

/// References that take long, kept as files of numbers in a folder: after an interruption, and for scenes that press
/// the same body in the same way.
class ReferenceCache {
 public:
  ReferenceCache() = default;  ///< keeps nothing
  explicit ReferenceCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// What was kept under `key` (any text that says all it depends on), else what `compute` gives, kept from now on.
  std::vector<double> get(const std::string& key, const std::function<std::vector<double>()>& compute) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace palpate::study

#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "tools/study/method.hpp"

namespace palpate::study {

/// The finished points of a study in a folder, one file each, under a key that says what they hold for.
class Store {
 public:
  /// Points under another key are dropped.
  Store(const std::filesystem::path& folder, const std::string& key);

  /// What was found for a point, if it is there and whole.
  std::optional<Result> find(const Point& point) const;
  void keep(const Point& point, const Result& result) const;

 private:
  std::filesystem::path file(const Point& point) const;

  std::filesystem::path folder_;
};

/// The key of a scene's study: everything that its figures depend on, apart from the machine.
std::string study_key(const Scene& scene, bool quick);

}  // namespace palpate::study

#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "tools/study/method.hpp"

namespace palpate::study {

/// The finished points of a study in a folder, one file each, under a key that says what they hold for.
class Store {
 public:
  /// Points under another key are dropped. Throws std::runtime_error if the place is taken by something else, or cannot
  /// be written.
  Store(const std::filesystem::path& folder, const std::string& key);

  bool is_new() const { return new_; }  ///< no point had been kept under this key

  /// What was found for a point, if it is there and whole.
  std::optional<Result> find(const Point& point) const;
  void keep(const Point& point, const Result& result) const;

 private:
  std::filesystem::path file(const Point& point) const;

  std::filesystem::path folder_;
  bool new_ = false;
};

/// The key of a scene's study: everything that its figures depend on, apart from the machine.
std::string study_key(const Scene& scene, bool quick);

}  // namespace palpate::study

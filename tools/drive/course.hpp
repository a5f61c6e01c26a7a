#pragma once
#include <cstdio>
#include <filesystem>
#include <memory>

#include "common/sim/simulator.hpp"

namespace palpate::drive {

/// A CSV file with a line for each step: time [s], then per tool the tip's place [m] and the force [N] on it, both in
/// the world, and the torque [N m] on the handle.
class Course {
 public:
  /// Throws std::runtime_error if the file cannot be written.
  Course(const std::filesystem::path& file, const Scene& scene);
  void write(const sim::Simulator& simulator);
  void finish();  ///< throws std::runtime_error if something could not be written

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace palpate::drive

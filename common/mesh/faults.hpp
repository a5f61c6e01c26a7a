#pragma once
#include <string>
#include <vector>

namespace palpate {

/// Collects what is wrong with a file: counts every fault, keeps the first few sentences.
class FaultList {
 public:
  void add(std::string fault);
  long count() const { return count_; }

  /// Throws std::runtime_error("WHERE: first; second; ... and N more faults") unless there is none.
  void raise(const std::string& where) const;

 private:
  static constexpr int kListed = 5;
  std::vector<std::string> first_;
  long count_ = 0;
};

}  // namespace palpate

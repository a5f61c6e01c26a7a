#pragma once
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/models/check/check.hpp"

namespace palpate {

/// What `palpate check` says: lines, printed as the check goes on, or JSON with the same sentences under what they are
/// about.
class CheckOutput {
 public:
  explicit CheckOutput(bool json) : json_(json) {}

  /// A figure or a name of the scene; in the text the line says it.
  void fact(std::string_view key, const std::string& value, const std::string& line);
  /// What is said from now on is about this one of "bodies" or "tools"; an empty list: about the scene.
  void about(std::string_view list, const std::string& name);
  /// A line without its end; in JSON without its indentation.
  void say(std::string_view line);
  void memory(std::span<const MemoryPart> parts);
  void nodes(const std::vector<std::string>& names);  ///< that `palpate run` starts
  void left_out(std::string_view line);
  void warn(const std::string& sentence);
  nlohmann::ordered_json json() const;  ///< all that was said, where it is asked for

 private:
  nlohmann::ordered_json& here();

  bool json_, headed_ = false;
  std::string list_;
  nlohmann::ordered_json all_;
};

}  // namespace palpate

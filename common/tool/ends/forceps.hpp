#pragma once
#include "common/tool/ends/kind.hpp"

namespace palpate {

/// Segments of the shaft and of two jaws that open by the grip.
struct ForcepsSpec {
  static constexpr std::string_view kKind = "forceps";
  static constexpr std::string_view kMeaning = "segments of the shaft and of two jaws that open by the grip";
  TurningJaws jaws;
};

inline void describe(Description& d, ForcepsSpec& f) {
  d.table({"jaws", "", "two jaws at the tip; needed for a forceps", Need::required}, f.jaws);
}

EndAbilities abilities(const ForcepsSpec& forceps);
std::vector<ToolPart> end_parts(const ForcepsSpec& forceps, const Tool& tool, double opening);
std::string sentence(const ForcepsSpec& forceps, const Tool& tool);
std::unique_ptr<ToolEnd> make_tool_end(const ForcepsSpec& forceps, const EndPlace& place);

}  // namespace palpate

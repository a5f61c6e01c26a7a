#pragma once
#include "common/tool/ends/kind.hpp"

namespace palpate {

/// Spheres along tip and shaft.
struct ProbeSpec {
  static constexpr std::string_view kKind = "probe";
  static constexpr std::string_view kMeaning = "a ball at the tip of a shaft";
  double radius = 0.004;  ///< [m] of the spherical tip
  std::optional<Cautery> cautery;
  std::optional<ClosingJaws> jaws;
};

inline void describe(Description& d, ProbeSpec& p) {
  d.number({"radius", "m", "of a probe's spherical tip"}, p.radius, above(0));
  d.table({"cautery", "", "an electric scalpel; not for a forceps", Need::optional, Use::agreed, "cannot cut"},
          p.cautery);
  if (p.cautery && p.cautery->radius == 0) p.cautery->radius = p.radius;
  d.table({"jaws", "", "two jaws at the tip; needed for a forceps", Need::optional, Use::agreed, "cannot grasp"},
          p.jaws);
}

EndAbilities abilities(const ProbeSpec& probe);
std::vector<ToolPart> end_parts(const ProbeSpec& probe, const Tool& tool, double opening);
std::string sentence(const ProbeSpec& probe, const Tool& tool);
std::unique_ptr<ToolEnd> make_tool_end(const ProbeSpec& probe, const EndPlace& place);

}  // namespace palpate

#include "common/models/check/loads_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/models/check/surface_check.hpp"

namespace palpate {
namespace {

void say_sag(const Archive& archive, CheckReport& report) {
  const auto most = std::ranges::max_element(archive.sag, {}, [](const Eigen::Vector3d& u) { return u.norm(); });
  if (most != archive.sag.end())
    report.say(fmt::format("  sag: {:.3g} mm at node {} at rest under its loads and weight", 1e3 * most->norm(),
                           archive.surface.node_number[most - archive.sag.begin()]));
}

}  // namespace

void say_loads(const MeshedSpec& body, const Eigen::Vector3d& gravity, const CheckSettings& settings,
               CheckReport& report) {
  for (const LoadSpec& load : body.loads) {
    const std::string where = describe(load.where, "nodes");
    if (load.pressure != 0)
      report.say(fmt::format("  load: {:g} Pa on {}", load.pressure, where));
    else
      report.say(fmt::format("  load: {:g} {:g} {:g} N on {}", load.force.x(), load.force.y(), load.force.z(), where));
  }
  if (!gravity.isZero(0))
    report.say(fmt::format("  weight: gravity {:g} {:g} {:g} m/s2", gravity.x(), gravity.y(), gravity.z()));
  report.sags |= !body.loads.empty() || !gravity.isZero(0);
  if (const auto archive = settings.stored(ArchivePart::header)) say_sag(*archive, report);
}

}  // namespace palpate

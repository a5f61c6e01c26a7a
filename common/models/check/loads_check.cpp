#include "common/models/check/loads_check.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "common/models/check/surface_check.hpp"

namespace palpate {
namespace {

constexpr double kMuchSag = 0.1;  // of the diagonal: beyond it linear elements say little

Sag sag_of(const Archive& archive) {
  const auto most = std::ranges::max_element(archive.sag, {}, [](const Eigen::Vector3d& u) { return u.norm(); });
  const std::size_t at = most - archive.sag.begin();
  Eigen::AlignedBox3d box;
  for (std::size_t n = 0; n < archive.sag.size(); ++n) box.extend(archive.surface.position[n] - archive.sag[n]);
  return {most->norm(), archive.surface.node_number[at], box.diagonal().norm()};
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
  if (const auto archive = settings.stored(ArchivePart::header); archive && !archive->sag.empty())
    say_sag(body.name, sag_of(*archive), "", report);
}

void say_sag(const std::string& body, const Sag& sag, std::string_view by, CheckReport& report) {
  const double share = sag.most / sag.diagonal;
  report.say(fmt::format("  sag: {:.3g} mm at node {} at rest under its loads and weight, {:.2g} % of its diagonal{}",
                         1e3 * sag.most, sag.node, 100 * share, by));
  if (sag.most == 0)
    report.warnings.push_back(fmt::format("body '{}' is not moved by its loads: all of their nodes are fixed", body));
  if (share > kMuchSag)
    report.warnings.push_back(
        fmt::format("body '{}' sinks by {:.2g} of its diagonal under its loads and weight: linear "
                    "tissue is right for small strains alone",
                    body, share));
}

}  // namespace palpate

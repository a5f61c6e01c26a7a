#include "haptic_node/interventions.hpp"

#include <array>

#include "common/devices/lease.hpp"
#include "idl/messages.hpp"

namespace palpate {

void Interventions::look(const Seen& seen) {
  struct Kind {
    bool now;
    std::string_view said;
  };
  // The worst first.
  const std::array kinds{
      Kind{(seen.flags & fault) != 0, "a fault has taken the force away: a pose or a force was not a number"},
      Kind{seen.refused_samples > last_.refused_samples,
           "samples of a device are refused: out of range, or far from the tool and not confirmed by the next"},
      Kind{seen.followed > last_.followed, "a tool follows its device at a bounded speed: the device has jumped"},
      Kind{seen.refused_models > last_.refused_models,
           "local contact models are refused: they name a haptic step that is still to come"},
      Kind{seen.implausible_models > last_.implausible_models,
           "local contact models are refused: they cannot be of this tissue"},
      Kind{(seen.flags & implausible_force) != 0,
           "the force of moving tissue is limited: a local contact model asks for more than the tissue can give"},
      Kind{(seen.flags & stale_model) != 0, "the force of moving tissue fades: its local contact models come too late"},
      Kind{(seen.flags & late_tissue) != 0, "the tissue that is felt moves too slowly: its time is late"},
      Kind{(seen.flags & silent_device) != 0, kDriverSilent},
      Kind{(seen.flags & force_limited) != 0, "the force is limited: more was asked for than the tool's port gives"},
      Kind{(seen.flags & slew_limited) != 0, "the force is limited: it rises no faster than the tool's port lets it"},
      Kind{(seen.flags & passivity_limited) != 0,
           "the tools are damped: they took out more energy than they had put in"}};
  last_ = seen;
  news_.clear();
  status_.clear();
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    if (!kinds[k].now) continue;
    if (status_.empty()) status_ = kinds[k].said;
    if (!(told_ & 1u << k)) news_.emplace_back(kinds[k].said);
    told_ |= 1u << k;
  }
}

}  // namespace palpate

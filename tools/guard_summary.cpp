#include "tools/guard_summary.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace palpate {
namespace {

struct Count {
  const char *node, *key, *what;
};

constexpr Count kInterventions[] = {
    {"haptic_node", "fault_steps", "steps without force after a fault"},
    {"haptic_node", "refused_samples", "samples of a device refused"},
    {"haptic_node", "followed_steps", "steps in which a tool followed its device at a bounded speed"},
    {"haptic_node", "silent_device_steps", "steps in which a tool stood, its driver being silent"},
    {"haptic_node", "refused_models", "local contact models refused"},
    {"haptic_node", "implausible_models", "local contact models that cannot be of this tissue"},
    {"haptic_node", "implausible_force_steps", "steps in which one asked for more force than the tissue can give"},
    {"haptic_node", "stale_model_steps", "steps in which the force of moving tissue faded"},
    {"haptic_node", "force_limited_steps", "steps in which more force was asked for than the port gives"},
    {"haptic_node", "refused_contacts", "contacts that a peer kept refused"},
    {"haptic_node", "refused_messages", "messages refused"},
    {"deform_node", "refused", "messages that the deformation node refused"},
    {"render_node", "refused", "messages that the picture refused"},
    {"web_node", "refused_messages", "messages that the live view refused"},
    {"web_node", "thrown_out", "pages that it threw out"}};

constexpr Count kLimits[] = {
    {"haptic_node", "slew_limited_steps", "steps in which the force rose no faster than the port lets it"},
    {"haptic_node", "passivity_limited_steps", "steps damped"},
    {"haptic_node", "late_tissue_steps", "steps in which tissue was felt whose time was late"},
    {"haptic_node", "behind_s", "s in which the force's steps were late"},
    {"deform_node", "behind_s", "s in which the tissue's time went slower"},
    {"render_node", "behind_s", "s in which pictures were left out"}};

template <std::size_t N>
std::string told(const Count (&counts)[N], const nlohmann::json& summary) {
  std::string said;
  for (const auto& [name, key, what] : counts) {
    const nlohmann::json node = summary.value(name, nlohmann::json());
    const std::uint64_t count = node.is_object() ? node.value(key, std::uint64_t{0}) : 0;
    if (count > 0) said += fmt::format("{}{} {}", said.empty() ? "" : ", ", count, what);
  }
  return said;
}

}  // namespace

std::string interventions_in(const nlohmann::json& summary) {
  const std::string said = told(kInterventions, summary);
  return said.empty() ? said : "the hand was guarded: " + said;
}

std::string untold_steps_in(const nlohmann::json& summary) {
  const nlohmann::json haptic = summary.value("haptic_node", nlohmann::json());
  const std::uint64_t count = haptic.is_object() ? haptic.value("dropped", std::uint64_t{0}) : 0;
  if (count == 0) return "";
  return fmt::format(
      "the haptic node told nobody of {} steps, and a log lacks them: its publishing thread had no processor", count);
}

std::string limits_met_in(const nlohmann::json& summary) {
  return told(kLimits, summary);
}

}  // namespace palpate

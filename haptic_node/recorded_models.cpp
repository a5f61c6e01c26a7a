#include "haptic_node/recorded_models.hpp"

#include <limits>

#include "idl/topics.hpp"

namespace palpate {

RecordedModels::RecordedModels(const std::filesystem::path& log, RunOrder order, std::uint64_t tool_run)
    : log_(log), order_(std::move(order)), tool_run_(tool_run) {}

RecordedModels::Place RecordedModels::place(std::uint64_t run, std::uint64_t seq) const {
  const auto known = order_.find(run);
  return {known == order_.end() ? std::numeric_limits<int>::max() : known->second, seq};
}

const LocalContactModel* RecordedModels::find(std::uint32_t tool, std::uint64_t run, std::uint64_t seq) {
  if (!order_.contains(run)) return nullptr;
  const Place wanted = place(run, seq);
  auto& models = waiting_[tool];
  while (!models.empty() && place(models.front().run, models.front().seq) < wanted) models.pop_front();
  LogEvent event;
  LocalContactModel model;
  while (models.empty() && !at_end_) {
    at_end_ = !log_.next(event);
    if (at_end_ || !event.read(topics::local_contact_model, model) || model.tool_run != tool_run_) continue;
    if (model.tool == tool && place(model.run, model.seq) < wanted) continue;
    waiting_[model.tool].push_back(std::move(model));
  }
  const bool found = !models.empty() && place(models.front().run, models.front().seq) == wanted;
  return found ? &models.front() : nullptr;
}

}  // namespace palpate

#include "haptic_node/local_feed.hpp"

namespace palpate {

struct LocalFeed::OfTool {
  Latest<LocalModel> newest;
};

LocalFeed::LocalFeed(Bus& bus, const HapticStep& haptic, std::uint64_t run) : run_(run), limits_(haptic.limits()) {
  if (!haptic.has_moving_tissue()) return;
  for (int t = 0; t < haptic.tools(); ++t) of_tool_.push_back(std::make_unique<OfTool>());
  copy_ = std::make_unique<LocalModel>();
  reader_ = bus.reader(topics::local_contact_model);
}

LocalFeed::~LocalFeed() = default;

void LocalFeed::take() {
  while (const auto message = reader_->take()) {
    const bool ours = message->tool_run == run_ && message->run == owner_.load(std::memory_order_relaxed);
    if (!ours || message->tool >= of_tool_.size()) continue;
    if (copy_model(*message, limits_, *copy_))
      of_tool_[message->tool]->newest.put(*copy_);
    else
      implausible_.fetch_add(1, std::memory_order_relaxed);
  }
}

void LocalFeed::give(HapticStep& haptic) {
  for (std::size_t t = 0; t < of_tool_.size(); ++t) {
    const LocalModel& model = of_tool_[t]->newest.get();
    const LocalModel& used = haptic.local(static_cast<int>(t)).model();
    if (model.seq == 0 || (model.seq == used.seq && model.run == used.run)) continue;
    if (model.tool_step < haptic.steps())
      haptic.consume(static_cast<int>(t), model);
    else
      refused_.fetch_add(1, std::memory_order_relaxed);
  }
}

}  // namespace palpate

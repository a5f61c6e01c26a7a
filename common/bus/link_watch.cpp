#include "common/bus/link_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {

std::vector<std::string> LinkWatch::look(const Presence& presence, std::int64_t now_ns) {
  std::vector<std::string> said;
  if (company_ns_ == 0) company_ns_ = now_ns;
  leave_out_pause(now_ns);
  std::erase_if(heard_, [&](const auto& entry) { return !presence.peers().contains(entry.first); });
  for (const auto& [node, peer] : presence.peers()) {
    const NodeStatus& status = peer.status;
    Heard& heard = heard_[node];
    if (status.seq != heard.seq) {
      if (heard.silent) said.push_back(fmt::format("{} is back", node));
      heard = {status.role, status.seq, now_ns, false};
    } else if (!heard.silent && now_ns - heard.last_ns > kSilentAfterNs) {
      heard.silent = true;
      said.push_back(fmt::format("nothing from {} for {:.1f} s: it has ended, or the network is cut", node,
                                 1e-9 * static_cast<double>(now_ns - heard.last_ns)));
    }
    if (!heard.silent) company_ns_ = now_ns;
  }
  const bool alone = now_ns - company_ns_ > kAloneAfterNs;
  if (alone && !said_alone_) said.push_back(fmt::format("alone for 5 s; listening in {}", place_));
  said_alone_ = alone;
  return said;
}

void LinkWatch::leave_out_pause(std::int64_t now_ns) {
  const std::int64_t pause_ns = looked_ns_ == 0 ? 0 : std::max<std::int64_t>(now_ns - looked_ns_ - kLookNs, 0);
  looked_ns_ = now_ns;
  company_ns_ += pause_ns;
  for (auto& [node, heard] : heard_) heard.last_ns += pause_ns;
}

std::string LinkWatch::silence(const std::string& role, std::int64_t now_ns) const {
  const Heard* newest = nullptr;
  std::string name;
  for (const auto& [node, heard] : heard_) {
    if (heard.role != role || (newest && heard.last_ns < newest->last_ns)) continue;
    newest = &heard;
    name = node;
  }
  if (!newest || !newest->silent) return {};
  return fmt::format("nothing from {} for {:.0f} s", name, 1e-9 * static_cast<double>(now_ns - newest->last_ns));
}

bool LinkWatch::same_silence(std::string_view a, std::string_view b) {
  const auto of_whom = [](std::string_view said) { return said.substr(0, said.rfind(" for ")); };
  return of_whom(a) == of_whom(b);
}

}  // namespace palpate

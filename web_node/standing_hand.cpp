#include "web_node/standing_hand.hpp"

namespace palpate::web {

void StandingHand::heard(const Said& said, std::int64_t now) {
  answered_ = now;
  if (said.kind == Said::release || said.kind == Said::give || said.kind == Said::rest) last_.reset();
  if (said.kind != Said::sample) return;
  last_ = said;
  since_ = now;
}

std::optional<Said> StandingHand::again(std::int64_t now) {
  if (!stands(now) || now - answered_ > kAnswers) return {};
  ++last_->motion.number;
  last_->motion.again = true;
  return last_;
}

}  // namespace palpate::web

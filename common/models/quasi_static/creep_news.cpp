// What a quasi-static body that relaxes tells others: the loads that stand for its past.
#include <algorithm>

#include "common/models/quasi_static/quasi_static_body.hpp"

namespace palpate {
namespace {

constexpr double kMinShare = 1e-3;  // of the largest load; what is smaller would not be seen

}  // namespace

std::vector<BodyNews> QuasiStaticBody::news() const {
  if (!memory_) return {};
  CreepState state;
  state.loads.reserve(memory_->max_creep_loads());
  std::vector<BodyNews> news(1);
  news[0].message = std::move(state);  // a copy would have no room
  return news;
}

void QuasiStaticBody::tell(BodyMessage& message) {
  auto& loads = std::get<CreepState>(message).loads;
  loads.clear();
  double largest = 0;
  memory_->for_each_creep_load([&](int, const Eigen::Vector3d& load) { largest = std::max(largest, load.norm()); });
  memory_->for_each_creep_load([&](int node, const Eigen::Vector3d& load) {
    if (load.isZero(0) || load.norm() < kMinShare * largest) return;
    const Eigen::Vector3f l = load.cast<float>();
    loads.push_back({static_cast<std::uint32_t>(node), {l[0], l[1], l[2]}});
  });
}

}  // namespace palpate

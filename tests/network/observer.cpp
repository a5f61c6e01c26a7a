#include "tests/network/observer.hpp"

#include <algorithm>
#include <cmath>

#include "common/realtime/clock.hpp"
#include "tests/network/nodes.hpp"

namespace palpate::testing {
namespace {

bool all_finite(const ForceState& f) {
  const auto finite = [](double x) { return std::isfinite(x); };
  return std::ranges::all_of(f.force, finite) && std::ranges::all_of(f.torque, finite) && finite(f.energy);
}

}  // namespace

Observer::Observer(const TwoHosts& hosts, const std::filesystem::path& keys) {
  const Inside here(hosts.a());
  bus_ = make_dds_bus({.domain = Nodes::kDomain,
                       .interface = TwoHosts::device,
                       .peers = {TwoHosts::address_b},
                       .keys = keys,
                       .role = "observer"});
  tools_ = bus_->reader(topics::tool_state);
  forces_ = bus_->reader(topics::force_state, Keep::all);
  surface_reader_ = bus_->reader(topics::surface_state);
  picture_reader_ = bus_->reader(topics::picture_state);
  changes_ = bus_->reader(topics::topology_change, Keep::all);
  statuses_ = bus_->reader(topics::node_status);
}

bool Observer::listen(std::chrono::milliseconds limit, const std::function<bool()>& enough) {
  const auto end = std::chrono::steady_clock::now() + limit;
  do {
    bus_->wait(std::chrono::milliseconds(5));
    take();
    if (enough()) return true;
  } while (std::chrono::steady_clock::now() < end);
  return false;
}

void Observer::take() {
  while (const auto m = tools_->take()) tool = *m;
  while (const auto m = forces_->take()) take(*m);
  while (auto m = surface_reader_->take()) {
    surfaces.push_back({m->run, m->step, m->sense_ns, now_ns()});
    surface = std::move(*m);
  }
  while (const auto m = picture_reader_->take()) pictures.push_back({m->run, m->step, m->sense_ns, m->publish_ns});
  while (auto m = changes_->take()) changes.push_back(std::move(*m));
  while (auto m = statuses_->take()) known_[m->node] = std::move(*m);
}

void Observer::take(const ForceState& next) {
  forces.add(next);
  finite = finite && all_finite(next);
  min_energy = std::min(min_energy, next.energy);
  if (next.run == force.run)
    max_jump = std::max(max_jump, std::hypot(next.force[0] - force.force[0], next.force[1] - force.force[1],
                                             next.force[2] - force.force[2]));
  force = next;
}

NodeStatus Observer::status(const std::string& role) const {
  NodeStatus newest;
  for (const auto& [name, status] : known_)
    if (status.role == role && status.stamp_ns >= newest.stamp_ns) newest = status;
  return newest;
}

std::vector<double> ages(const Observer::Frames& frames, std::int64_t since_ns) {
  std::vector<double> all;
  for (const Observer::Frame& f : frames)
    if (f.came_ns >= since_ns) all.push_back(1e-9 * static_cast<double>(f.came_ns - f.sense_ns));
  std::ranges::sort(all);
  return all;
}

std::int64_t first_since(const Observer::Frames& frames, std::int64_t sense_ns) {
  for (const Observer::Frame& f : frames)
    if (f.sense_ns >= sense_ns) return f.came_ns;
  return 0;
}

bool never_go_back(const Observer::Frames& frames) {
  for (std::size_t i = 1; i < frames.size(); ++i)
    if (frames[i].run == frames[i - 1].run && frames[i].step < frames[i - 1].step) return false;
  return true;
}

double at_share(const std::vector<double>& sorted, double share) {
  return sorted.empty() ? 0 : sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

}  // namespace palpate::testing

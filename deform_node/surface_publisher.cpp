#include "deform_node/surface_publisher.hpp"

#include <cstring>

#include "common/realtime/clock.hpp"

namespace palpate {

SurfacePublisher::SurfacePublisher(Bus& bus, std::span<const std::size_t> nodes)
    : writer_(bus.writer(topics::surface_state)), messages_(nodes.size()) {
  for (std::size_t b = 0; b < nodes.size(); ++b) {
    messages_[b].body = static_cast<std::uint32_t>(b);
    messages_[b].position.resize(3 * nodes[b]);
    messages_[b].normal.resize(3 * nodes[b]);
  }
}

void SurfacePublisher::publish(int body, std::span<const Eigen::Vector3f> position,
                               std::span<const Eigen::Vector3f> normal, const Origin& origin) {
  SurfaceState& m = messages_[body];
  std::memcpy(m.position.data(), position.data(), m.position.size() * sizeof(float));
  std::memcpy(m.normal.data(), normal.data(), m.normal.size() * sizeof(float));
  m.run = origin.run;
  m.step = origin.step;
  m.sense_ns = origin.sense_ns;
  m.publish_ns = last_ns_ = now_ns();
  ++m.seq;
  writer_->write(m);
}

}  // namespace palpate

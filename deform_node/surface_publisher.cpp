#include "deform_node/surface_publisher.hpp"

#include <cstring>

#include "common/geometry/arrays.hpp"
#include "common/realtime/clock.hpp"

namespace palpate {

SurfacePublisher::SurfacePublisher(Bus& bus, const Deformer& deformer)
    : writer_(bus.writer(topics::surface_state)), messages_(deformer.bodies()) {
  for (int b = 0; b < deformer.bodies(); ++b) {
    const std::size_t numbers = 3 * deformer.map(b).position.size();
    messages_[b].body = static_cast<std::uint32_t>(b);
    messages_[b].position.resize(numbers);
    messages_[b].normal.resize(numbers);
  }
}

void SurfacePublisher::publish(int body, const Shape& shape, const Moment& moment) {
  SurfaceState& m = messages_[body];
  std::memcpy(m.position.data(), shape.position.data(), m.position.size() * sizeof(float));
  std::memcpy(m.normal.data(), shape.normal.data(), m.normal.size() * sizeof(float));
  copy(shape.origin, m.origin);
  m.run = moment.run;
  m.step = moment.step;
  m.sense_ns = moment.sense_ns;
  stamp(moment.tissue, m);
  m.publish_ns = last_ns_ = now_ns();
  ++m.seq;
  writer_->write(m);
}

}  // namespace palpate

// What a simulator remembers, as bytes and as a hash.
#include <stdexcept>

#include "common/bus/codec.hpp"
#include "common/describe/hash64.hpp"
#include "common/sim/simulator.hpp"

namespace palpate::sim {
namespace {

template <class M>
void visit(State& s, M& message) {
  Bytes bytes;
  if (!s.restoring()) encode(message, bytes);
  s.list(bytes);
  s.require(!s.restoring() || decode(bytes, message), "the recorded state holds no such message");
}

}  // namespace

void Simulator::state(State& s) {
  s.value(steps_);
  haptic_.state(s);
  world_.state(s);
  local_models_.state(s);
  for (ContactState& contacts : contacts_) visit(s, contacts);
  for (BodyNews& news : record_.news) std::visit([&](auto& message) { visit(s, message); }, news.message);
}

void Simulator::forget_factors() {
  haptic_.forget_factors();
  for (int i = 0; i < world_.organs(); ++i) world_.organ(i).forget_factors();
}

std::vector<std::uint8_t> Simulator::save() {
  std::vector<std::uint8_t> bytes;
  State s = State::save(bytes);
  state(s);
  forget_factors();
  return bytes;
}

void Simulator::restore(std::span<const std::uint8_t> from) {
  if (steps_ > 0) throw std::runtime_error("a state is restored before the first step");
  State s = State::restore(from);
  state(s);
  if (s.size() != from.size()) throw std::runtime_error("the recorded state is of another scene");
  for (const ContactState& m : contacts_) deformer_.take(m);
  for (const BodyNews& news : record_.news) deformer_.take(news.message);
}

std::uint64_t Simulator::hash() const {
  Hash64 hash;
  State s = State::hash(hash);
  const_cast<Simulator*>(this)->state(s);
  for (int t = 0; t < tools(); ++t) {  // what it gives out and does not remember
    hash.add(tool(t).flags);
    hash.add(tool(t).trocar_force);
  }
  return hash.value();
}

}  // namespace palpate::sim

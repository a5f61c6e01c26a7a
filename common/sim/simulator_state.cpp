// What a simulator remembers, as bytes and as a hash.
#include <stdexcept>

#include "common/bus/codec.hpp"
#include "common/sim/digest.hpp"
#include "common/sim/simulator.hpp"
#include "common/describe/state_bytes.hpp"

namespace palpate::sim {
namespace {

using state_bytes::put, state_bytes::put_one, state_bytes::take, state_bytes::take_one;

template <class M>
void put_messages(std::vector<std::uint8_t>& to, const std::vector<M>& messages) {
  for (const M& m : messages) {
    Bytes bytes;
    encode(m, bytes);
    put(to, std::span<const std::uint8_t>(bytes));
  }
}

template <class M>
void take_messages(std::span<const std::uint8_t>& from, std::vector<M>& messages) {
  for (M& m : messages)
    if (!decode(take<std::uint8_t>(from), m)) throw std::runtime_error("the recorded state holds no such message");
}

}  // namespace

std::vector<std::uint8_t> Simulator::save() {
  std::vector<std::uint8_t> haptic(haptic_.state_size()), bytes;
  haptic_.save(haptic);  // forgets its own factors
  for (int i = 0; i < world_.organs(); ++i) world_.organ(i).forget_factors();
  put_one(bytes, steps_);
  put(bytes, std::span<const std::uint8_t>(haptic));
  put(bytes, std::span<const std::uint8_t>(world_.save()));
  put(bytes, std::span<const std::uint8_t>(local_models_.save()));
  put_messages(bytes, contacts_);
  put_messages(bytes, modal_);
  put_messages(bytes, catheters_);
  return bytes;
}

void Simulator::restore(std::span<const std::uint8_t> state) {
  if (steps_ > 0) throw std::runtime_error("a state is restored before the first step");
  const auto steps = take_one<std::uint64_t>(state);
  haptic_.restore(take<std::uint8_t>(state));
  world_.restore(take<std::uint8_t>(state));
  local_models_.restore(take<std::uint8_t>(state));
  take_messages(state, contacts_);
  take_messages(state, modal_);
  take_messages(state, catheters_);
  if (!state.empty()) throw std::runtime_error("the recorded state is of another scene");
  for (const ContactState& m : contacts_) deformer_.take(m);
  for (const ModalState& m : modal_) deformer_.take(m);
  for (const CatheterState& m : catheters_) deformer_.take(m);
  steps_ = steps;
}

std::uint64_t Simulator::hash() const {
  Digest digest;
  digest.add(steps_);
  for (int t = 0; t < tools(); ++t) {
    const ToolView view = tool(t);
    digest.add(std::span<const double>(view.pose.data(), 16));
    for (const Eigen::Vector3d& v : {view.force, view.torque, view.trocar_force}) digest.add(v);
    for (const double x : {view.opening, view.grip_torque}) digest.add(x);
    digest.add(view.flags);
  }
  digest.add(energy());
  Bytes contacts;
  for (const ContactState& m : contacts_) encode(m, contacts);
  digest.add(std::span<const std::uint8_t>(contacts));
  digest.add(world_.hash());
  for (const auto& m : haptic_.modal_bodies()) digest.add(m.part->coordinates());
  for (const auto& c : haptic_.catheters())
    digest.add(std::span<const Eigen::Vector3d>(c.part->body().positions()));
  return digest.value();
}

}  // namespace palpate::sim

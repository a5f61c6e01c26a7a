#include "common/models/quasi_static/force_memory.hpp"

#include <algorithm>

namespace palpate {
namespace {

constexpr int kPatience = 32;       // steps without force after which a trace is handed over
constexpr int kNodesPerStep = 256;  // of the field, and as many more for each kWaitingPerPiece traces that wait
constexpr std::size_t kWaitingPerPiece = 16;

// Steps without force, up to now.
int waited(const LoadTrace& t) {
  return t.force.isZero(0) ? t.idle : 0;
}

}  // namespace

ForceMemory::ForceMemory(const CreepStep& step, const Compliance<double>& softened, std::size_t max_loaded)
    : step_(step),
      softened_(softened),
      room_(std::min<std::size_t>(2 * max_loaded, softened.column_nodes())),
      trace_of_(softened.column_nodes(), -1),
      faded_(step_, softened) {
  traces_.reserve(room_);
}

void ForceMemory::begin() {
  for (LoadTrace& t : traces_) {
    t.before = t.force;
    t.force.setZero();
  }
}

void ForceMemory::add(int node, const Eigen::Vector3d& force) {
  if (node >= softened_.column_nodes() || !force.allFinite()) return;
  if (trace_of_[node] < 0) {
    if (traces_.size() == room_) {
      faded_.advance(softened_.row_nodes());
      hand_over(longest_idle());  // not all carry force now, or did so a step ago
    }
    trace_of_[node] = static_cast<int>(traces_.size());
    traces_.push_back({.node = node});
  }
  traces_[trace_of_[node]].force += force;
}

void ForceMemory::end() {
  faded_.fade();
  std::size_t waiting = 0;
  for (LoadTrace& t : traces_) {
    t.follow(step_);
    waiting += waited(t) > 0;
  }
  faded_.advance(kNodesPerStep * static_cast<int>(1 + waiting / kWaitingPerPiece));
  if (faded_.busy() || waiting == 0) return;
  LoadTrace& idle = longest_idle();
  if (idle.idle >= kPatience) hand_over(idle);
}

LoadTrace& ForceMemory::longest_idle() {
  return *std::ranges::max_element(traces_, {}, waited);
}

// The last trace takes its place.
void ForceMemory::hand_over(LoadTrace& trace) {
  faded_.take(trace);
  trace_of_[trace.node] = -1;
  if (&trace != &traces_.back()) {
    trace = traces_.back();
    trace_of_[trace.node] = static_cast<int>(&trace - traces_.data());
  }
  traces_.pop_back();
}

void ForceMemory::state(State& s) {
  std::size_t count = traces_.size();
  s.value(count);
  s.require(count <= room_, "the state holds more loads than can be");
  if (s.restoring()) {
    traces_.resize(count);
    std::ranges::fill(trace_of_, -1);
  }
  const std::size_t terms = step_.terms().size();
  for (LoadTrace& t : traces_) {
    s.value(t.node);
    s.value(t.idle);
    s.value(t.force);
    s.all(std::span(t.lag).first(terms));
    s.require(t.node >= 0 && t.node < softened_.column_nodes(), "the state holds a load of no node");
    if (s.restoring()) trace_of_[t.node] = static_cast<int>(&t - traces_.data());
  }
  s.skip((room_ - count) * (2 * sizeof(int) + (1 + terms) * sizeof(Eigen::Vector3d)));
  faded_.state(s);
}

}  // namespace palpate

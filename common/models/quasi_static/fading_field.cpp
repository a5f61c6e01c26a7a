#include "common/models/quasi_static/fading_field.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kMinScale = 1e-12;         // below it a part is written anew
constexpr double kMinDisplacement = 1e-15;  // [m] what is smaller then is zero
constexpr double kMinForce = 1e-9;          // [N] likewise; a load that small is forgotten

}  // namespace

FadingField::FadingField(const CreepStep& step, const Compliance<double>& softened) : step_(step), softened_(softened) {
  for (Part& part : parts()) part.displacement.assign(3 * static_cast<std::size_t>(nodes()), 0.0);
  faded_.reserve(kMaxLoads + 1);
}

void FadingField::take(const LoadTrace& trace) {
  taken_ = trace;
  done_ = 0;
}

void FadingField::advance(int more) {
  if (!busy()) return;
  const int end = std::min(nodes(), done_ + more);
  for (std::size_t k = 0; k < parts().size(); ++k) {
    if (taken_.lag[k].isZero(0)) continue;
    Part& part = parts_[k];
    const Vector3d by = taken_.lag[k] / (part.scale * step_.instant());
    for (int node = done_; node < end; ++node)
      Eigen::Map<Vector3d>(part.displacement.data() + 3 * node) += softened_.block(node, taken_.node) * by;
    part.used = true;
  }
  done_ = end;
  if (done_ == nodes()) remember();
}

// The smallest of the loads makes room; the field keeps what it has left.
void FadingField::remember() {
  Faded now{.node = taken_.node};
  for (std::size_t k = 0; k < parts().size(); ++k) now.lag[k] = taken_.lag[k] / parts_[k].scale;
  faded_.push_back(now);
  taken_.node = -1;
  if (faded_.size() <= kMaxLoads) return;
  const auto size = [this](const Faded& f) { return load_of(f).squaredNorm(); };
  faded_.erase(std::ranges::min_element(faded_, {}, size));
}

Vector3d FadingField::load_of(const Faded& faded) const {
  Vector3d load = Vector3d::Zero();
  for (std::size_t k = 0; k < step_.terms().size(); ++k) load += step_.terms()[k].gain * parts_[k].scale * faded.lag[k];
  return load;
}

void FadingField::fade() {
  for (std::size_t k = 0; k < parts().size(); ++k) {
    const double keep = step_.terms()[k].keep;
    if (busy()) taken_.lag[k] *= keep;
    if (!parts_[k].used) continue;
    parts_[k].scale *= keep;
    if (parts_[k].scale < kMinScale) rescale(k);
  }
}

void FadingField::rescale(std::size_t k) {
  Part& part = parts_[k];
  part.used = false;
  for (double& u : part.displacement) {
    u *= part.scale;
    if (std::abs(u) < kMinDisplacement) u = 0;
    part.used |= u != 0;
  }
  for (Faded& f : faded_) {
    f.lag[k] *= part.scale;
    if (f.lag[k].norm() < kMinForce) f.lag[k].setZero();
    part.used |= !f.lag[k].isZero(0);
  }
  part.scale = 1;
  std::erase_if(faded_, [](const Faded& f) {
    return std::ranges::all_of(f.lag, [](const Vector3d& lag) { return lag.isZero(0); });
  });
}

void FadingField::add(Moment moment, std::span<const int> at, std::span<double> displacement) const {
  for (std::size_t k = 0; k < step_.terms().size(); ++k) {
    const Part& part = parts_[k];
    if (!part.used) continue;
    const CreepStep::Term& term = step_.terms()[k];
    const double factor = part.scale * term.gain * (moment == Moment::ahead ? term.keep : 1.0);
    for (std::size_t i = 0; i < at.size(); ++i)
      for (int axis = 0; axis < 3 && at[i] < nodes(); ++axis)
        displacement[3 * i + axis] += factor * part.displacement[3 * at[i] + axis];
  }
  if (!busy()) return;
  const Vector3d load = taken_.load(step_, moment) / step_.instant();
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (at[i] < done_ || at[i] >= nodes()) continue;
    Eigen::Map<Vector3d>(displacement.data() + 3 * i) += softened_.block(at[i], taken_.node) * load;
  }
}

void FadingField::state(State& s) {
  for (Part& part : parts()) {
    s.value(part.scale);
    s.value(part.used);
    s.all(part.displacement);
  }
  s.value(taken_.node);
  s.all(taken_.lag);
  s.value(done_);
  s.require(taken_.node < softened_.column_nodes() && done_ >= 0 && done_ <= nodes(),
            "the state holds a load that this body cannot have");
  std::size_t count = faded_.size();
  s.value(count);
  s.require(count <= kMaxLoads, "the state holds more past loads than can be");
  if (s.restoring()) faded_.resize(count);
  for (Faded& f : faded_) {
    s.value(f.node);
    s.all(f.lag);
    s.require(f.node >= 0 && f.node < softened_.column_nodes(), "the state holds a past load of no node");
  }
  s.skip((kMaxLoads - count) * (sizeof(int) + sizeof(LaggingForces)));
}

}  // namespace palpate

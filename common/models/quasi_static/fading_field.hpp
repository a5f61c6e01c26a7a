#pragma once
#include <array>
#include <span>
#include <vector>

#include "common/archive/compliance.hpp"
#include "common/describe/state.hpp"
#include "common/models/quasi_static/load_trace.hpp"

namespace palpate {

/// What is left, all over a body's touchable surface, of loads that have ended. Each of its parts, one a retardation
/// time, only fades: it is held as one field and a common factor, so that any number of old loads costs a step the
/// same. A load is taken in piece by piece, over as many steps as its columns are long. Nothing is dropped from the
/// field; of the loads themselves, which others need to draw it, the largest kMaxLoads are remembered. Nothing is
/// allocated after construction.
class FadingField {
 public:
  static constexpr std::size_t kMaxLoads = 256;

  /// `softened`: the compliance that a step's own force meets, CreepStep::instant() times the archive's. It outlives
  /// this object.
  FadingField(const CreepStep& step, const Compliance<double>& softened);

  /// Whether a load is being taken in; another one has to wait.
  bool busy() const { return taken_.node >= 0; }
  /// Begins with a load whose force has ended.
  void take(const LoadTrace& trace);
  /// Takes in up to so many nodes more.
  void advance(int nodes);
  /// All fades by one step.
  void fade();

  /// Adds its displacements [m] of nodes, three entries a node.
  void add(Moment moment, std::span<const int> nodes, std::span<double> displacement) const;
  /// Visits (node, creep load [N]); a node may come several times.
  template <class Visit>
  void for_each_load(Visit&& visit) const {
    if (busy()) visit(taken_.node, taken_.creep_load(step_));
    for (const Faded& f : faded_) visit(f.node, load_of(f));
  }

  void state(State& s);

 private:
  /// One part of the field: to be multiplied by `scale`.
  struct Part {
    double scale = 1;
    bool used = false;
    std::vector<double> displacement;  ///< [m] three a touchable node
  };
  /// A load that has been taken in, by the scales of the parts.
  struct Faded {
    int node = -1;
    LaggingForces lag = no_lag();
  };

  int nodes() const { return softened_.row_nodes(); }
  std::span<Part> parts() { return std::span(parts_).first(step_.terms().size()); }
  Eigen::Vector3d load_of(const Faded& faded) const;
  void remember();
  void rescale(std::size_t part);

  const CreepStep& step_;
  const Compliance<double>& softened_;
  std::array<Part, Relaxation::kMaxTerms> parts_;
  LoadTrace taken_;
  int done_ = 0;  ///< nodes whose displacement by taken_ is in the field
  std::vector<Faded> faded_;
};

}  // namespace palpate

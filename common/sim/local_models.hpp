#pragma once
#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "common/sim/dynamic_world.hpp"
#include "common/sim/felt_part.hpp"
#include "common/sim/local_stiffness.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// Makes the local contact models of all tools: what they hold and touch, the surface around them, and its static
/// stiffness, which a thread of its own keeps working out unless the caller is to.
class LocalModels {
 public:
  static constexpr int kMaxContacts = 32, kMaxNodes = 40, kMaxTriangles = 32;  ///< a message of 5 kB a millisecond

  /// One archive per body of the scene.
  LocalModels(const DynamicWorld& world, const std::vector<Archive>& archives,
              LocalStiffness::Worker worker = LocalStiffness::Worker::thread);

  /// Fills everything but run, seq and late_ns, after a tick; false if no dynamic tissue is near the tool.
  bool describe(int tool, LocalContactModel& model);
  /// Asks for the stiffness that the tools' places need now, and takes what has been worked out. Call once a tick.
  void refresh();

  /// What is known of the stiffness; where the caller works it out.
  void state(State& s);

 private:
  struct OfOrgan {
    std::unique_ptr<LocalStiffness> stiffness;
    std::vector<std::unique_ptr<FeltPart>> parts;
    double look_ahead = 0;  ///< [m] beyond a sphere's surface
    std::vector<int> wanted;
  };
  void add_origin(int tool, LocalContactModel& model) const;
  void add_contacts(int tool, int i, FeltPart& part, LocalContactModel& model);
  void add_surface(int tool, int i, const FeltPart& part, LocalContactModel& model);
  void add_triangles(int i, const FeltPart& part, LocalContactModel& model);

  const DynamicWorld& world_;
  std::vector<OfOrgan> organs_;
  std::vector<std::pair<double, int>> by_distance_;
  std::vector<int> seen_;
  std::uint64_t ticks_ = 0;
};

}  // namespace palpate

#pragma once
#include <array>
#include <limits>
#include <vector>

#include "common/contact/jaw_obstacles.hpp"
#include "common/contact/spec.hpp"
#include "common/describe/state.hpp"
#include "common/models/moving/local_model.hpp"
#include "common/models/moving/tool_reach.hpp"
#include "common/tool/instrument.hpp"
#include "common/tool/kinematics.hpp"

namespace palpate {

/// Moving tissue as one tool feels it: the force of all dynamic bodies, from the newest local contact model that the
/// deform node sent for this tool. Where the tissue is held, its force follows the tool's motion since the model's pose
/// by the stiffness in it; a part of the tool that held nothing is felt by how deep it has come into the near surface,
/// which gives way as its nodes do and, where the tissue's own contacts do so, as a half-space under the part.
/// Age counts in haptic steps, so that a replay gives the same bits. While no model comes the force rises no more and
/// changes by small steps, whatever the tool passes in the tissue that stands, then fades; what comes after a silence,
/// or from another deform node, comes in from the present force. Tissue whose own time stands still or goes slower is
/// felt as it is, and told. Never allocates.
class LocalBody {
 public:
  static constexpr double kOldest = 0.15;        ///< [s] age of a model at which its force begins to fade
  static constexpr double kFadeSeconds = 0.05;   ///< [s] from full force to none, and back
  static constexpr double kExtrapolated = 0.02;  ///< [s] at most for which nodes move on with their velocity
  static constexpr double kRises = 0.005;        ///< [s] without a model after which the force rises no more
  static constexpr double kTurns = 0.02;         ///< [s] at least in which it is then gone, or has another direction
  static constexpr double kSilent = 0.02;        ///< [s] without a model after which the next comes in gradually
  static constexpr double kLately = 0.1;         ///< [s] over which time that the tissue lost is forgotten
  static constexpr double kLate = 0.01;          ///< [s] lost lately from which on the tissue is late
  /// [m] Beyond two radii of a part, or its jaws' reach: what a tool holds is nearer.
  static constexpr double kBeside = 0.01;

  /// `contact`: of the scene; dt [s]: the haptic step.
  LocalBody(const Tool& tool, const ContactSpec& contact, double dt);

  /// From the next step on this model is used.
  void consume(const LocalModel& model);
  const LocalModel& model() const { return state_.model; }

  /// Force and torque on the tool in haptic step `step`. Its parts are those of `tool`, a probe's tip first. `most`
  /// [N]: no more of it is rendered.
  ToolLoad load(const MovingTool& tool, std::uint64_t step, double most = std::numeric_limits<double>::infinity());
  /// True if the last load asked for more.
  bool limited() const { return limited_; }
  /// How far this tool can have pressed or drawn tissue.
  ToolReach& reach() { return reach_; }
  const ToolReach& reach() const { return reach_; }
  /// What lies between a forceps' jaws, as the surface was in the last load().
  BetweenJaws between(const OpenJaws& jaws);
  /// [N] by which the jaws held tissue in the last load().
  double grasp_load() const { return grasp_force_.norm(); }
  /// True if the last load was less than it should be, because the model is too old or has only just come back.
  bool stale() const { return stale_; }
  /// True if the last load is of tissue that has lost more than kLate of its time of late: at once, or a tenth of it.
  bool late() const { return late_; }

  /// Restoring throws std::runtime_error on counts or indices that no model has.
  void state(State& s);

 private:
  struct Memory {
    LocalModel model;
    double weight = 0;         ///< share of the model's force that is rendered
    std::uint64_t silent = 0;  ///< steps since a model came
    double ceiling = 0;        ///< [N] while silent: the size beyond which the force does not rise
    std::array<double, 3> model_force{}, model_torque{};  ///< [N], [N m] that the model asked for in the last load
    std::array<double, 3> force{}, torque{};              ///< [N], [N m] of the last load
    std::array<double, 3> from_force{}, from_torque{};    ///< of the load from which the model comes in
    double from_share = 0;                                ///< of that load, which is still rendered
    double from_weight = 0;                               ///< share of the force that it was
    double lost = 0;                                      ///< [s] of the tissue's time, of late
  };
  struct Held {
    Eigen::Vector3d at;  ///< [m] where the tool holds tissue now
    bool grasped;
  };
  struct Touched {
    Eigen::Vector3d at, force;  ///< [m], [N] on the tissue
  };

  void add(const Eigen::Vector3d& at, const Eigen::Vector3d& on_tissue, const MovingTool& tool, ToolLoad& load) const;
  int hold(const MovingTool& tool, ToolLoad& load);
  void count_lost(const LocalModel& model);
  void keep_within(double most, ToolLoad& load);
  void keep_steady(ToolLoad& load);
  void come_from_before(ToolLoad& load);
  double weight() const { return state_.weight + state_.from_share * state_.from_weight; }  ///< of all that is rendered
  void extrapolate(double seconds);
  bool touch(const MovingTool& tool, int part, Touched& touched) const;
  double half_space(int part, double radius, double depth) const;
  bool holds(const Segment& axis, double radius, int part, int held) const;
  bool dented(const Eigen::Vector3d& at, double radius, int held) const;

  Trocar trocar_;
  JawParts jaws_;
  double jaws_reach_;           ///< [m]
  bool patches_;                ///< tissue gives way under parts as a half-space
  std::vector<char> by_patch_;  ///< per part: a patch presses
  double friction_, dt_;
  std::uint64_t rises_, silent_;  ///< steps in kRises and kSilent
  Memory state_;
  Eigen::Isometry3d model_pose_ = Eigen::Isometry3d::Identity();
  bool stale_ = false, limited_ = false, late_ = false;
  ToolReach reach_;
  Eigen::Vector3d grasp_force_ = Eigen::Vector3d::Zero();  ///< [N] on the tissue
  JawObstacles obstacles_;
  std::array<Held, LocalModel::kMaxContacts> held_{};
  std::array<Eigen::Vector3d, LocalModel::kMaxNodes> position_;
  std::array<std::array<Eigen::Vector3d, 2>, LocalModel::kMaxTriangles> box_;
};

}  // namespace palpate

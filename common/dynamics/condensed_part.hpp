#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/archive/compliance.hpp"
#include "common/contact/contact_law.hpp"
#include "common/contact/patch/patch.hpp"
#include "common/dynamics/dynamic_model.hpp"

namespace palpate {

/// The quasi-static part of a hybrid body at run time, condensed on its connection nodes (RR3510 sec. 6; see
/// CondensedTensors for the symbols). It answers the tensor-mass part with forces on the connection nodes in every
/// stage of the integrator, and moves with them at once, without inertia of its own beyond the mass that the connection
/// nodes carry for it.
///
/// Tools touch it through a ContactLaw on its own compliance. Points held there are held together with the
/// connection nodes: with J their rows, the forces f = G (d - J x), G = (J C J^T)^-1, follow the connection
/// nodes within a step,
///   f_c = -(S + (J H)^T G (J H)) u_c + g_c + (J H)^T G (d - J x_0).
/// One round of the owner's loop, all tools being rigid and known:
///   take(model)          where the connection nodes are
///   update(nodes)        positions() of the nodes near the tools, for the search for contacts
///   law().contacts()     added, removed and aimed by the owner
///   hold()               which contacts press, stick and slide; condenses them on the connection nodes
///   add_loads(model)     the constant part, on top of what the owner has set
///   model.step(dt) ...   calls apply()
///   take(model)          contact_force() and the nodes' displacements, at the new state
/// Nodes are those of the archive. Nothing is allocated after construction.
class CondensedPart final : public Coupling {
 public:
  static constexpr int kMaxContacts = 32;

  /// The archive read with ArchivePart::surface. `single`: S u in single precision, for a model in single
  /// precision. Throws std::runtime_error if the archive has no condensed part or was read in part.
  CondensedPart(const Archive& archive, double friction, bool single);
  CondensedPart(const CondensedPart&) = delete;
  CondensedPart& operator=(const CondensedPart&) = delete;

  /// Puts this part's mass, forces and frequency bound on the model's connection nodes. The bound covers S,
  /// points held, and the stiffness of contacts that rest on connection nodes; that may be what is free below
  /// the model's own bound, or as much as `bound` of CondensedTensors.
  void couple(DynamicModel& model);
  std::span<const int> connection() const { return connection_; }

  /// Dead force [N] on a touchable node of this part; stays until set again. Takes effect with hold(). Throws
  /// std::runtime_error for any other node.
  void set_force(int node, const Eigen::Vector3d& force);

  /// Beside the law's contacts, so many patches may press this part. push() says the last forces of one, in place of
  /// its earlier ones: on nodes of this part alone they count from then on, as the law's contacts do; what a patch does
  /// to the connection nodes, draw() [N, three entries each] says, and it is for the caller to put in.
  void expect_patches(int patches);
  void push(int patch, std::span<const PatchForce> forces);
  void draw(int patch, std::span<double> force) const;
  /// [m/N] of a node under a force on another one that lasts for one step, where connection nodes give way by
  /// `inertia` [m/N], three entries each. Both belong to this part, if with others.
  Eigen::Matrix3d give(int node, int under, std::span<const double> inertia) const;

  void take(const DynamicModel& model);
  /// The same, with given forces [N] of the law's contacts: to go on from a recorded state.
  void adopt(const DynamicModel& model, std::span<const Eigen::Vector3d> forces);
  /// Fills in positions() for these nodes of this part (connection nodes included).
  void update(std::span<const int> nodes);
  std::span<const Eigen::Vector3d> positions() const { return position_; }
  /// Contacts anchored on nodes of this part; anchors may have weight on connection nodes, which yield by
  /// their mass.
  ContactLaw& law() { return law_; }
  const ContactLaw& law() const { return law_; }
  LawOutcome hold();

  /// [N] constant force on connection()[k]: weight of this part, its dead forces and what contacts hold. The
  /// weight of quasi-static elements at the connection nodes is in it; the model's gravity is for its own
  /// tetrahedra alone.
  Eigen::Vector3d load(int k) const { return Eigen::Map<const Eigen::Vector3d>(load_.data() + 3 * k); }
  /// Adds load() to the model's loads, in place of what the last call added.
  void add_loads(DynamicModel& model);

  void apply(const double* u, double* force) override;

  /// [N] on the tissue, of law().contacts()[contact], at the last take().
  Eigen::Vector3d contact_force(int contact) const { return contact_force_[contact]; }
  /// [m] of a node of this part at the last take().
  Eigen::Vector3d displacement(int node) const;
  /// [m] Displacements of all visible nodes of this part, connection nodes included, per archive node; others
  /// are left.
  void superpose(std::span<Eigen::Vector3f> displacement);
  /// [N/m] Static stiffness of a touchable node of this part while the connection nodes stand still; zero
  /// elsewhere.
  Eigen::Matrix3d stiffness(int node) const;
  /// [m] Largest distance between the two sides of a partial connection at the last take(); 0 at a full one.
  double gap(const DynamicModel& model) const;
  /// Whether a node belongs to this part alone.
  bool owns(int node) const { return row_[node] >= 0; }
  /// Whether it belongs to it at all.
  bool touches(int node) const { return owns(node) || place_[node] >= 0; }
  double mass(int k) const { return mass_[k]; }  ///< [kg] that connection()[k] carries for this part
  /// [m/N] between nodes of this part while the connection nodes stand still.
  Eigen::Matrix3d compliance(int i, int j) const;
  /// [1] How far a node of this part alone goes along an axis with each dof of the connection nodes.
  std::span<const double> follow(int node, int axis) const {
    return {follow_.data() + static_cast<std::size_t>(size_) * (row_[node] + axis), static_cast<std::size_t>(size_)};
  }

 private:
  template <class T>
  using Array = std::vector<T, kernels::LineAllocator<T>>;

  /// One held direction of one contact.
  struct HeldRow {
    int contact;
    Eigen::Vector3d axis;
  };
  using NodeForce = PatchForce;

  void fill_stiffness(const CondensedTensors& condensed);
  void fill_follow(const Archive& archive);
  Eigen::Vector3d followed(int node) const;
  Eigen::Matrix3d compliance(const Anchor& a, const Anchor& b) const;
  Eigen::Vector3d respond(int node, std::span<const NodeForce> forces) const;
  Eigen::Vector3d pushed(int node) const;
  double softness(const TouchContact& contact) const;
  void count_shares();
  void list_rows();
  void fill_row(int row);
  void factorise();
  void condense();
  void add_follow_force(const Anchor& anchor, const Eigen::Vector3d& force);
  void add_follow_force(int node, const Eigen::Vector3d& force, std::span<double> to) const;
  Eigen::Vector3d still_position(const Anchor& anchor) const;
  void find_forces();
  void list_node_forces();

  std::vector<Eigen::Vector3d> rest_;    // per node
  std::vector<int> connection_, place_;  // nodes; per node its place among them, or -1
  std::vector<double> mass_;
  double bound_, contact_bound_, friction_, typical_;
  int size_ = 0;  // three entries per connection node
  bool single_;
  Array<float> stiffness_f_, follow_f_;  // S, H by columns
  Array<double> stiffness_d_;
  std::vector<const float*> stiffness_columns_f_, follow_columns_f_;
  std::vector<const double*> stiffness_columns_d_;
  std::vector<double> follow_;  // H by rows
  std::vector<int> row_;        // per node: its first row of H, or -1
  std::vector<double> reaction_;
  std::vector<Eigen::Vector3d> sag_;  // per node
  std::vector<GapPair> gap_;
  Compliance<double> compliance_;
  Compliance<float> picture_;

  std::vector<Eigen::Vector3d> free_, position_;  // per node: without and with the forces of contacts
  CompliantResponse response_;
  ContactLaw law_;
  std::vector<NodeForce> dead_, node_forces_;
  std::vector<std::vector<NodeForce>> pushed_;  // per patch
  std::vector<HeldRow> rows_;
  std::vector<int> row_begin_;  // first row of each contact, and the end
  kernels::Buffer factor_, floor_;
  Array<double> held_, product_, multiplier_, constant_;  // J H by rows; S u; and per row
  std::vector<const double*> held_rows_;
  std::vector<int> shares_;                                      // per connection node: contacts that rest on it
  std::vector<Eigen::Vector3d> friction_force_, contact_force_;  // per contact
  std::vector<double> u_, load_, added_;                         // per connection dof
  std::vector<float> u_f_;
  Array<float> product_f_, whole_;
  std::vector<const float*> columns_;
  std::vector<float> coefficients_;
};

}  // namespace palpate

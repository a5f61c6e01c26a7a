#pragma once
#include <array>
#include <vector>

namespace palpate {

/// A degree of freedom of a body: node index of its archive (SurfaceMap) and axis.
struct Dof {
  int node;
  int axis;
  bool operator==(const Dof&) const = default;
};

/// A node on one side of a partial connection and the point opposite to it at rest.
struct GapPair {
  int node;                       ///< index of the archive
  std::array<int, 3> triangle;    ///< nodes of the nearest triangle of the other side
  std::array<double, 3> weights;  ///< barycentric
  bool operator==(const GapPair&) const = default;
};

/// What a hybrid body's quasi-static part is to its tensor-mass part (RR3510 sec. 6). With c the free dofs of
/// the connection nodes and i all other free dofs of the quasi-static elements, displacements of the
/// connection nodes move the quasi-static part, and it answers with forces on them:
///   u_i = H u_c + u_g + C_ii f_i                 H = -K_ii^-1 K_ic,  u_g = K_ii^-1 w_i
///   f_c = -S u_c + g_c + H^T f_i                 S = K_cc + K_ci H,  g_c = w_c + H^T w_i
/// w: weight of the quasi-static elements, lumped. H and u_g are stored for the visible dofs among i.
struct CondensedTensors {
  std::vector<int> connection;  ///< connection nodes, ascending
  std::vector<double> mass;     ///< [kg] per connection node: lumped mass of its quasi-static elements
  /// [rad^2/s^2] Largest eigenvalue of K_cc against `mass`: covers S, and S with any points of i held.
  double bound = 0;
  bool held_by_connection = false;  ///< some piece has no fixed node: the connection nodes alone hold it
  std::vector<Dof> dofs;            ///< c, ascending
  std::vector<double> stiffness;    ///< S [N/m], packed lower triangle by rows as Archive::touchable_compliance
  std::vector<double> reaction;     ///< g_c [N]
  std::vector<double> follow;       ///< H [1], row-major: touchable_dofs, then other_dofs, by dofs
  std::vector<double> sag;          ///< u_g [m]: touchable_dofs, then other_dofs
  int quasi_static_triangles = 0;   ///< the surface's triangles before this are faces of quasi-static elements
  /// Faces between the parts, outward of the quasi-static part: three connection nodes, and the facet (4 t +
  /// f: face f, opposite to vertex f, of dynamic tetrahedron t) that covers it. Visible once t is gone.
  std::vector<std::array<int, 4>> interface;
  std::vector<GapPair> gap;  ///< empty at a full connection
  double max_gap = 0;        ///< [m] at rest, over `gap`

  bool operator==(const CondensedTensors&) const = default;
};

}  // namespace palpate

#include "tools/generate/liver.hpp"

#include <Eigen/Geometry>
#include <numeric>
#include <set>

#include "common/mesh/fill.hpp"
#include "tools/generate/wrap.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

Eigen::Matrix3d turn_about(const Vector3d& axis, double degrees) {
  return Eigen::AngleAxisd(degrees * EIGEN_PI / 180, axis).toRotationMatrix();
}

// The massive right lobe under the right dome of the diaphragm, the medial part, and the flat left lobe that
// tapers towards the spleen.
double lobes(const Vector3d& p) {
  const Eigen::Matrix3d right_turn = turn_about(Vector3d::UnitX(), -28) * turn_about(Vector3d::UnitY(), 12);
  const Eigen::Matrix3d left_turn = turn_about(Vector3d::UnitZ(), 12) * turn_about(Vector3d::UnitY(), -6);
  const double right = ellipsoid(p, {-0.054, 0.006, -0.004}, {0.072, 0.074, 0.065}, right_turn);
  const double medial =
      ellipsoid(p, {-0.004, -0.022, -0.003}, {0.074, 0.062, 0.052}, turn_about(Vector3d::UnitY(), -16));
  const double left = ellipsoid(p, {0.056, -0.012, 0.022}, {0.082, 0.058, 0.026}, left_turn);
  return smooth_union(smooth_union(right, medial, 0.04), left, 0.05);
}

// The visceral side: hollowed by stomach and bowel, and at the back by the right kidney.
double hollow(const Vector3d& p) {
  const double stomach =
      ellipsoid(p, {0.056, 0.060, -0.116}, {0.135, 0.135, 0.104}, turn_about(Vector3d::UnitY(), -18));
  const double kidney = ellipsoid(p, {-0.062, 0.075, -0.078}, {0.075, 0.085, 0.062});
  return smooth_union(stomach, kidney, 0.03);
}

// Keeps the file short and the same on every machine.
void round_to_micrometres(std::vector<Vector3d>& nodes) {
  for (Vector3d& x : nodes) x = (x * 1e6).array().round() / 1e6;
}

// The upper back of the right lobe, where no peritoneum covers the liver and the diaphragm holds it: surface
// triangles inside an ellipsoid there.
std::vector<int> bare_area(const TetMesh& mesh, const TriangleMesh& surface) {
  const auto inside = [&](int n) {
    return (mesh.nodes[n] - Vector3d(-0.036, 0.062, 0.036)).cwiseQuotient(Vector3d(0.060, 0.040, 0.042)).norm() < 1;
  };
  std::set<int> nodes;
  for (const auto& t : surface.triangles) {
    if (inside(t[0]) && inside(t[1]) && inside(t[2])) nodes.insert(t.begin(), t.end());
  }
  return {nodes.begin(), nodes.end()};
}

}  // namespace

ImplicitShape liver_shape() {
  return [](const Vector3d& p) {
    double d = smooth_cut(lobes(p), hollow(p), 0.034);
    // gall bladder fossa, from the lower margin back to the hilum
    d = smooth_cut(d, capsule(p, {-0.012, -0.120, -0.084}, {0.004, -0.012, -0.038}, 0.024), 0.034);
    // hilum, across the visceral side
    d = smooth_cut(d, capsule(p, {-0.026, 0.012, -0.030}, {0.026, 0.010, -0.022}, 0.018), 0.030);
    // fissure of the round ligament: the notch between the lobes
    d = smooth_cut(d, capsule(p, {0.052, -0.106, -0.020}, {0.044, -0.056, -0.032}, 0.020), 0.034);
    // groove of the inferior vena cava in the back, beside the spine
    d = smooth_cut(d, capsule(p, {0.018, 0.086, -0.08}, {0.018, 0.086, 0.08}, 0.024), 0.034);
    return d;
  };
}

TetMesh make_liver(const LiverOptions& options) {
  TriangleMesh surface = wrap(liver_shape(), {0.13, 0.09, 0.06}, options.frequency);
  round_to_micrometres(surface.nodes);
  TetMesh mesh = fill_surface(surface, options.inner_size);
  round_to_micrometres(mesh.nodes);

  MeshGroup& liver = mesh.groups["liver"];
  liver.nodes.resize(mesh.nodes.size());
  std::iota(liver.nodes.begin(), liver.nodes.end(), 0);
  liver.tetrahedra.resize(mesh.tetrahedra.size());
  std::iota(liver.tetrahedra.begin(), liver.tetrahedra.end(), 0);
  mesh.groups["attachment"].nodes = bare_area(mesh, surface);
  return mesh;
}

}  // namespace palpate

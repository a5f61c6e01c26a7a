#pragma once
#include <random>

#include "common/archive/archive.hpp"
#include "common/mesh/shell_generators.hpp"
#include "common/mesh/tube.hpp"
#include "common/scene/scene.hpp"

/// A scene of an organ, a duct and a catheter with invented numbers: bodies 0, 1 and 2.
namespace palpate::testing {

inline constexpr int kOrganBody = 0, kDuctBody = 1, kCatheterBody = 2;

/// Random symmetric compliance among the first `touchable` nodes and from them to the other nodes but the last
/// `fixed` ones [m/N].
inline void add_compliance(Archive& archive, int touchable, int fixed, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1e-3, 1e-3);
  const int n = archive.surface.size();
  archive.surface.touchable = touchable;
  archive.surface.fixed.resize(n);
  for (int i = 0; i < n; ++i) {
    archive.surface.node_number.push_back(i);
    for (int axis = 0; axis < 3; ++axis) {
      if (i >= n - fixed) archive.surface.fixed[i][axis] = true;
      if (i < touchable) archive.touchable_dofs.push_back({i, axis});
      if (i >= touchable && i < n - fixed) archive.other_dofs.push_back({i, axis});
    }
  }
  const std::size_t columns = archive.touchable_dofs.size();
  for (std::size_t k = 0; k < columns * (columns + 1) / 2; ++k) archive.touchable_compliance.push_back(number(random));
  for (std::size_t k = 0; k < archive.other_dofs.size() * columns; ++k)
    archive.other_compliance.push_back(number(random));
}

struct DuctScene {
  static constexpr int kModes = 12, kParticles = 20, kAround = 12, kAlong = 8;
  Scene scene;
  std::vector<Archive> archives{3};

  DuctScene() {
    scene.title = "a duct";
    ModalShellSpec duct;
    duct.shell = {.thickness = 0.001, .modes = kModes};
    CatheterSpec catheter;
    catheter.catheter = {
        .inside = "duct", .tail = {0, 0, -0.05}, .tip = {0, 0, 0.045}, .radius = 0.00125, .particles = kParticles};
    scene.bodies = {QuasiStaticSpec{}, duct, catheter};
    make_organ();
    make_duct();
    make_catheter();
  }

  /// Rest positions of the particles, moved by `along` [m] and bent: the particle i stands `bend` i^2 to the side.
  CatheterState catheter_state(double kAlong = 0, double bend = 0) const {
    const Catheter& c = as<CatheterSpec>(scene.bodies[kCatheterBody])->catheter;
    CatheterState state{.body = kCatheterBody, .run = 5, .seq = 1, .step = 7, .sense_ns = 1000};
    for (int i = 0; i < kParticles; ++i) {
      Eigen::Vector3d p = c.tail + (c.tip - c.tail) * i / (kParticles - 1);
      p += Eigen::Vector3d(bend * i * i, 0, kAlong);
      state.position.insert(state.position.end(), {p.x(), p.y(), p.z()});
    }
    return state;
  }

  ModalState modal_state() const {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1, 1);
    ModalState state{.body = kDuctBody, .run = 5, .seq = 1, .step = 6, .sense_ns = 900};
    for (int m = 0; m < kModes; ++m) state.coordinates.push_back(1e-4 * number(random));
    for (const std::uint32_t node : {0u, 7u, 31u, 70u}) {
      const auto component = [&] { return static_cast<float>(number(random)); };
      state.forces.push_back({node, {component(), component(), component()}});
    }
    return state;
  }

 private:
  void make_organ() {
    Archive& organ = archives[kOrganBody];
    organ.surface.position = {{0, 0.05, 0}, {0.02, 0.05, 0}, {0, 0.07, 0}, {0, 0.05, 0.02}};
    organ.surface.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    add_compliance(organ, 3, 1, 1);
  }
  void make_duct() {
    const ShellMesh tube = make_tube(0.0045, 0.05, kAround, kAlong);
    Archive& duct = archives[kDuctBody];
    duct.model = "modal_shell";
    duct.surface.position = tube.nodes;
    duct.surface.triangles = tube.triangles;
    add_compliance(duct, duct.surface.size() - 2 * kAround, kAround, 2);
    duct.modal = ModalTensors{.thickness = 0.001};
    std::mt19937 random(4);
    std::normal_distribution<double> number(0, 10);
    for (int m = 0; m < kModes; ++m) {
      duct.modal->omega.push_back(10 + m);
      for (int row = 0; row < 3 * duct.surface.size(); ++row) {
        const bool fixed = row >= 3 * (duct.surface.size() - kAround);
        duct.modal->shape.push_back(fixed ? 0 : number(random));
      }
    }
    duct.modal->mass.assign(duct.surface.size(), 1e-5);
  }
  void make_catheter() {
    Archive& archive = archives[kCatheterBody];
    archive.model = "catheter";
    const TubeSurface tube(kParticles, 0.00125);
    std::vector<Eigen::Vector3d> rest;
    const std::vector<double> position = catheter_state().position;
    for (int i = 0; i < kParticles; ++i) rest.emplace_back(position[3 * i], position[3 * i + 1], position[3 * i + 2]);
    std::vector<Eigen::Vector3f> surface(tube.vertices()), normal(tube.vertices());
    tube.place(rest, surface, normal);
    for (const Eigen::Vector3f& p : surface) archive.surface.position.push_back(p.cast<double>());
    archive.surface.triangles = tube.triangles();
    archive.surface.fixed.resize(surface.size());
    for (int i = 0; i < archive.surface.size(); ++i) archive.surface.node_number.push_back(i);
  }
};

}  // namespace palpate::testing

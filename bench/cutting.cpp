// What does it cost to take a tetrahedron out of tissue while it moves? A box of 10,648 nodes, five
// tetrahedra to a cell, is cut at random places of its surface. Each removal brings everything up to date:
// topology with what else has to go, tensors and masses in single precision, visible surface and buckets.
#include <chrono>
#include <exception>
#include <random>

#include "bench/report.hpp"
#include "bench/soft_boxes.hpp"
#include "common/contact/cut_surface.hpp"
#include "common/dynamics/tensor_mass.hpp"
#include "common/mesh/cut_mesh.hpp"

namespace {
using namespace palpate;

constexpr Material kTissue{2e3, 0.45, 1000};
constexpr double kBucket = 0.01;  // [m] two cells
constexpr double kMotion = 2e-5;  // [m] per step

/// A step of the tissue in which all nodes move on alike.
void report_steps(CutSurface& surface, int count) {
  std::vector<Eigen::Vector3d> position(surface.positions().begin(), surface.positions().end());
  bench::Samples steps;
  for (int i = 0; i < count; ++i) {
    for (auto& x : position) x.z() += kMotion;
    steps.measure(0, 1, [&](int) { surface.set_positions(position); });
  }
  bench::report("follow_motion", "box10648", "p50", 1e6 * steps.median(), "us");
  bench::report("follow_motion", "box10648", "p99", 1e6 * steps.p99(), "us");
}

void run(bool quick) {
  const ElasticMesh mesh = bench::make_box10648(kTissue);
  CutMesh cut(mesh.tetrahedra, mesh.nodes());
  CutSurface surface(cut, mesh.rest, kBucket);
  TensorMass<float> tissue(mesh, Integrator::rk4, 5);
  report_steps(surface, quick ? 100 : 1000);

  std::mt19937 random(1);
  std::vector<int> removed;
  removed.reserve(mesh.tetrahedra.size());
  bench::Samples all, topology;
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::duration d) { return std::chrono::duration<double>(d).count(); };
  for (int i = 0; i < (quick ? 200 : 4000); ++i) {
    const int target = cut.visible()[random() % cut.visible().size()] / 4;
    const std::size_t first = removed.size();
    const auto begin = Clock::now();
    cut.remove(target, removed);
    surface.follow();
    const auto cut_now = Clock::now();
    tissue.remove(std::span(removed).subspan(first));
    const auto end = Clock::now();
    all.add(seconds(end - begin));
    topology.add(seconds(cut_now - begin));
  }
  bench::report("remove_tetrahedron", "box10648", "p50", 1e6 * all.median(), "us");
  bench::report("remove_tetrahedron", "box10648", "p99", 1e6 * all.p99(), "us");
  bench::report("remove_tetrahedron", "box10648", "without_tensors_p50", 1e6 * topology.median(), "us");
  bench::report("remove_tetrahedron", "box10648", "tetrahedra",
                static_cast<double>(removed.size()) / static_cast<double>(all.size()), "1");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(palpate::bench::quick(argc, argv));
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_cutting: {}\n", error.what());
    return 1;
  }
}

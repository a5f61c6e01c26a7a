#include "tools/study/growth.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <fstream>
#include <stdexcept>

#include "common/dynamics/element_tensors.hpp"
#include "common/dynamics/tensor_mass.hpp"
#include "common/mesh/generators.hpp"
#include "common/mesh/shell_generators.hpp"
#include "common/models/catheter/catheter_body.hpp"
#include "common/models/modal_shell/precompute.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "common/realtime/shutdown.hpp"
#include "tools/rig/example_bodies.hpp"
#include "tools/study/ball_press.hpp"
#include "tools/study/measure.hpp"

namespace palpate::study {
namespace {

/// Sizes and times of one question.
class Growth {
 public:
  Growth(const std::filesystem::path& folder, bool quick, std::function<void(const std::string&)> say)
      : out_(folder / "growth.csv"), quick_(quick), say_(std::move(say)) {
    out_ << "what,unit,size,step_us_median,step_us_p99\n";
  }

  int samples() const { return quick_ ? 300 : 3000; }
  bool quick() const { return quick_; }

  void add(const char* what, const char* unit, double size, std::vector<double> seconds) {
    const StepTime time = summarise(std::move(seconds));
    out_ << fmt::format("{},{},{:.6g},{:.6g},{:.6g}\n", what, unit, size, 1e6 * time.median, 1e6 * time.p99);
    if (!out_.flush()) throw std::runtime_error("growth.csv cannot be written");
    say_(fmt::format("{}: {:.6g} {}: {:.4g} us", what, size, unit, 1e6 * time.median));
    if (shutdown_requested()) throw Interrupted("stopped before its end: growth.csv has what was measured until then");
  }

 private:
  std::ofstream out_;
  bool quick_;
  std::function<void(const std::string&)> say_;
};

const Patch kTop{{0.0007, 0.0005, 0}, {0, 0, -1}, 0};

void over_surface_nodes(Growth& growth) {
  for (const int cells : growth.quick() ? std::vector{4, 6, 8} : std::vector{6, 8, 10, 12, 16, 20}) {
    const Archive archive = precompute(block_body<QuasiStaticSpec>(), block_mesh(cells));
    BallPress press(ball_scene({}, block_body<QuasiStaticSpec>(), kTop, 0.3 * 0.1 / cells), archive, kTop,
                    0.3 * 0.1 / cells);  // a single contact
    press.to(0.1 * 0.1 / cells);
    growth.add("haptic step", "surface nodes", archive.surface.size(), press.time(200, growth.samples()));
    growth.add("shape for the picture", "surface nodes", archive.surface.size(),
               time_steps(20, growth.samples() / 3, [&](int) { press.displacement(); }));
  }
}

void over_contacts(Growth& growth) {
  const int cells = growth.quick() ? 10 : 16;
  const Archive archive = precompute(block_body<QuasiStaticSpec>(), block_mesh(cells));
  for (const double radius : {0.008, 0.014, 0.022, 0.034, 0.05}) {
    BallPress press(ball_scene({}, block_body<QuasiStaticSpec>(), kTop, radius), archive, kTop, radius);
    press.to(0.3 * radius);
    const int held = held_points(press.rig().haptic(), 0);
    growth.add("haptic step of many contacts", "held contacts", held, press.time(200, growth.samples()));
  }
}

void over_edges(Growth& growth) {
  for (const int cells : growth.quick() ? std::vector{4, 6, 8} : std::vector{4, 6, 8, 12, 16, 22}) {
    const TetMesh mesh = make_block_of_five({0, 0, 0}, Eigen::Vector3d::Constant(0.01 * cells), {cells, cells, cells});
    ElasticMesh elastic{mesh.nodes, mesh.tetrahedra, {}, {{5000, 0.4, 1000}}, {}};
    for (const auto& x : mesh.nodes) elastic.fixed.push_back({x.z() == 0, x.z() == 0, x.z() == 0});
    const ElementTensors tensors(elastic);
    TensorMass<float> model(elastic, Integrator::rk4, 5);
    model.set_gravity({0, 0, -9.81});
    const double dt = 0.9 * max_step(Integrator::rk4, model.frequency_bound(), 5);
    growth.add("tensor-mass step (RK4)", "edges", static_cast<double>(tensors.edges().size()),
               time_steps(20, growth.samples() / 3, [&](int) { model.step(dt); }));
  }
}

void over_modes(Growth& growth) {
  const ShellMesh mesh = make_tube(0.0045, 0.06, 16, 24);
  for (const int modes : growth.quick() ? std::vector{10, 40} : std::vector{10, 20, 40, 80, 160, 320}) {
    ModalShellSpec body;
    body.name = "duct";
    body.material = {1e5, 0.45, 1050};
    body.fixed.push_back({{.where = {.indices = {}, .box = {}, .group = "end0"}}});
    body.shell = {.thickness = 8e-4, .modes = modes};
    const Archive archive = precompute(body, mesh);
    const Patch side{{0.0045, 0.0002, 0.031}, {-1, 0, 0}, 0};
    BallPress press(ball_scene({}, body, side, 0.002), archive, side, 0.0024);
    press.to(0.0006);
    growth.add("haptic step of a shell", "modes", modes, press.time(200, growth.samples()));
  }
}

void over_particles(Growth& growth) {
  for (const int particles : growth.quick() ? std::vector{20, 40} : std::vector{15, 30, 60, 120, 240}) {
    CatheterSettings settings;
    settings.shape.particles = particles;
    settings.shape.tip = {0, 0, 0.12};
    settings.shape.gravity = {0, -9.81, 0};
    settings.young = 5e7;
    CatheterBody body(settings, nullptr);
    body.grasp(0, Eigen::Isometry3d::Identity(), {0, 0.5}, body.spacing(), 1e-6);
    growth.add("catheter step", "particles", particles,
               time_steps(100, growth.samples(), [&](int) { body.step({}, {}); }));
  }
}

}  // namespace

void measure_growth(const std::filesystem::path& folder, bool quick,
                    const std::function<void(const std::string&)>& say) {
  std::filesystem::create_directories(folder);
  Growth growth(folder, quick, say);
  over_surface_nodes(growth);
  over_contacts(growth);
  over_edges(growth);
  over_modes(growth);
  over_particles(growth);
}

}  // namespace palpate::study

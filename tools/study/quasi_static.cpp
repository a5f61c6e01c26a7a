#include "tools/study/quasi_static.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "common/mesh/mesh_file.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "tools/study/ball_press.hpp"
#include "tools/study/kinds.hpp"
#include "tools/study/measure.hpp"
#include "tools/study/slides.hpp"

namespace palpate::study {
namespace {

constexpr std::size_t kMaxTetrahedra = 150000;  // of the mesh that tensors are taken from

/// Touchable nodes nearest to any of the patches, as mesh nodes.
std::vector<int> nearest_nodes(const SolidCase& solid, int count) {
  const SurfaceMap& surface = solid.surface();
  std::vector<double> distance(surface.touchable, 1e300);
  std::vector<int> order(surface.touchable);
  std::iota(order.begin(), order.end(), 0);
  for (int n = 0; n < surface.touchable; ++n)
    for (const Patch& p : solid.presses().patches)
      distance[n] = std::min(distance[n], (surface.position[n] - p.point).norm());
  std::ranges::stable_sort(order, {}, [&](int n) { return distance[n]; });
  std::vector<int> nodes;
  for (int i = 0; i < std::min(count, surface.touchable); ++i) nodes.push_back(surface.node_number[order[i]]);
  std::ranges::sort(nodes);
  return nodes;
}

/// The body, which becomes a quasi-static one if it is not.
QuasiStaticSpec& as_quasi_static(Body& body) {
  return body.emplace<QuasiStaticSpec>(as_kind<QuasiStaticSpec>(body));
}

class QuasiStatic : public Method {
 public:
  explicit QuasiStatic(std::shared_ptr<SolidCase> solid)
      : solid_(std::move(solid)), name_(solid_->name("quasi_static")) {}
  int body() const override { return solid_->index(); }

  std::vector<Point> points() const override {
    std::vector<Point> all;
    const bool serves = !find_motion(solid_->body());
    const int b = solid_->index();
    const QuasiStaticSpec own = as_kind<QuasiStaticSpec>(solid_->body());
    // `open`: the scene leaves it open, so that a budget may choose it.
    const auto add = [&](const std::string& knob, const std::string& value, const std::function<void(Scene&)>& change,
                         bool open = true) {
      all.push_back({name_, knob, value,
                     [=](Scene& scene) {
                       as_quasi_static(scene.bodies[b]);
                       change(scene);
                     },
                     serves && open});
    };
    add("scene", "as it is", [](Scene&) {});
    const ContactRule own_rule = solid_->scene().contact.rule;
    for (const ContactRule rule :
         {ContactRule::barycentric, ContactRule::alpha, ContactRule::patch})  // alpha is there for comparison
      if (rule != own_rule)
        add(
            "rule", std::string(word_of(rule)), [rule](Scene& scene) { scene.contact.rule = rule; },
            own_rule == ContactSpec{}.rule && rule != ContactRule::alpha);
    for (const int count : tensor_counts())
      add("tensors", std::to_string(count), [b, nodes = nearest_nodes(*solid_, count)](Scene& scene) {
        as_quasi_static(scene.bodies[b]).touchable = NodeSelector{{.indices = nodes, .box = {}, .group = {}}};
      });
    all.push_back({name_, "precision", "single", {}, serves});
    all.push_back({name_, "precision", "double", {}, serves});
    const std::vector<std::pair<std::string, Offline>> better{
        {"p1", {}},
        {"refine 1", {.refine = 1}},
        {"p2 refine 1", {.refine = 1, .element = FiniteElement::p2}},
        {"locking_free refine 1", {.refine = 1, .formulation = Formulation::locking_free}},
        {"refine 2", {.refine = 2}}};
    for (const auto& [value, offline] : better) {
      if (solid_->quick() && value != "p1") continue;
      add(
          "offline", value,
          [b, offline = offline](Scene& scene) { as_quasi_static(scene.bodies[b]).offline = offline; }, !own.offline);
    }
    if (own.nonlinear)
      add(
          "correction", "off", [b](Scene& scene) { as_quasi_static(scene.bodies[b]).nonlinear.reset(); }, false);
    return all;
  }

  Result evaluate(const Point& point) override {
    if (point.value == "refine 2" && 64 * solid_->mesh().tetrahedra.size() > kMaxTetrahedra)
      throw std::runtime_error(fmt::format("{} tetrahedra take palpate precompute many minutes; a study goes up to {}",
                                           64 * solid_->mesh().tetrahedra.size(), kMaxTetrahedra));
    Scene scene = solid_->scene();
    if (point.apply) point.apply(scene);
    QuasiStaticSpec& spec = as_quasi_static(scene.bodies[body()]);
    Row row{solid_->scene().file.stem().string(), point.method, point.knob, point.value};
    const auto begin = std::chrono::steady_clock::now();
    Archive archive = compute(spec);
    row.offline_s = seconds_since(begin);
    if (point.value == "single") round_tensors(archive);
    Result result;
    std::vector<double> seconds, shares;
    PressAnswers answers;
    const auto& presses = solid_->presses();
    const int samples = (solid_->quick() ? 600 : 2400) / static_cast<int>(presses.patches.size());
    for (std::size_t p = 0; p < presses.patches.size(); ++p) {
      const Scene alone = solid_->press_scene(scene, static_cast<int>(p));
      if (p == 0) row.memory_bytes = static_cast<double>(owner_bytes(alone, archive));
      BallPress press(alone, archive, presses.patches[p], presses.radius);
      answers.emplace_back();
      for (const double depth : presses.depths) {
        PressAnswer answer = press.to(depth);
        if (point.value == "double") superpose_in_double(archive, press, answer.displacement);
        answer.displacement = renumbered(answer.displacement, archive);
        answers.back().push_back(std::move(answer));
      }
      const auto times = press.time(200, samples);
      seconds.insert(seconds.end(), times.begin(), times.end());
      if (!slides(point)) continue;
      press.to(-0.5 * presses.radius, 0);
      const auto around = press_around(*solid_, static_cast<int>(p), press.rig());
      shares.insert(shares.end(), around.begin(), around.end());
    }
    const StepTime time = summarise(std::move(seconds));
    row.step_us_median = 1e6 * time.median;
    row.step_us_p99 = 1e6 * time.p99;
    if (point.value == "double") row.memory_bytes += 4.0 * archive.surface.size() * 3 * archive.surface.touchable * 3;
    solid_->add_errors(row, answers, result);
    if (slides(point)) add_slides(*solid_, scene, archive, row, shares, result);
    return result;
  }

 private:
  /// Whether the setting can change how a slide feels.
  static bool slides(const Point& point) {
    return point.knob == "scene" || point.knob == "rule" || point.knob == "offline";
  }

  std::vector<int> tensor_counts() const {
    const int all = solid_->surface().touchable;
    std::vector<int> counts{all / 2, all / 4, all / 10};
    if (solid_->quick()) counts = {all / 4};
    std::erase_if(counts, [](int c) { return c < 12; });
    return counts;
  }

  Archive compute(const QuasiStaticSpec& body) const {
    const std::optional<TetMesh> specimen = load_specimen(body);
    return precompute(with_offline(body, solid_->mesh()), solid_->mesh(), specimen ? &*specimen : nullptr);
  }

  /// Fewer touchable nodes come in another order.
  std::vector<Eigen::Vector3d> renumbered(const std::vector<Eigen::Vector3d>& u, const Archive& archive) const {
    std::vector<Eigen::Vector3d> of_mesh(solid_->mesh().nodes.size(), Eigen::Vector3d::Zero());
    for (std::size_t n = 0; n < u.size(); ++n) of_mesh[archive.surface.node_number[n]] = u[n];
    return solid_->at_surface(of_mesh);
  }

  static void round_tensors(Archive& archive) {
    for (auto* values : {&archive.touchable_compliance, &archive.other_compliance})
      for (double& c : *values) c = static_cast<double>(static_cast<float>(c));
  }

  /// Of what the deformer shows, what it superposes in single precision anew in double.
  static void superpose_in_double(const Archive& archive, BallPress& press, std::vector<Eigen::Vector3d>& u) {
    const Compliance<double> in_double(archive, Compliance<double>::Rows::surface);
    const Compliance<float> in_single(archive, Compliance<float>::Rows::surface);
    press.rig().haptic().part(0)->for_each_force([&](int, int node, const Eigen::Vector3d& f) {
      if (node >= in_double.column_nodes()) return;
      for (int n = 0; n < static_cast<int>(u.size()); ++n)
        u[n] += (in_double.block(n, node) - in_single.block(n, node).cast<double>()) * f;
    });
  }

  std::shared_ptr<SolidCase> solid_;
  std::string name_;
};

class Linearity : public Method {
 public:
  explicit Linearity(std::shared_ptr<SolidCase> solid) : solid_(std::move(solid)), name_(solid_->name("reference")) {}
  int body() const override { return solid_->index(); }

  std::vector<Point> points() const override {
    return {{name_, "law", "linear", {}, false}, {name_, "mesh", "coarser", {}, false}};
  }

  Result evaluate(const Point& point) override { return point.knob == "law" ? of_law(point) : of_mesh(point); }

 private:
  Row row(const Point& point) const {
    return {solid_->scene().file.stem().string(), point.method, point.knob, point.value};
  }

  Result of_law(const Point& point) {
    Result result;
    PressAnswers linear, neo;
    double penetration = 0;
    int nodes = 0, iterations = 0;
    for (std::size_t p = 0; p < solid_->presses().patches.size(); ++p) {
      const auto& both = solid_->nonlinearity(static_cast<int>(p));
      linear.push_back(both.linear);
      neo.push_back(both.neo_hookean);
      penetration = std::max(penetration, both.penetration);
      nodes = std::max(nodes, both.nodes);
      iterations += both.iterations;
      if (!both.gave_up.empty())
        result.notes.push_back(
            {row(point).scene, point.method, point.knob, point.value, fmt::format("patch {}: {}", p, both.gave_up)});
    }
    solid_->errors().add(row(point), linear, neo, "neo_hookean", result);
    result.notes.push_back({row(point).scene, point.method, point.knob, point.value,
                            fmt::format("neo-Hookean reference: up to {} nodes; {} Newton iterations; nodes "
                                        "lie at most {:.2g} % of the radius inside the ball",
                                        nodes, iterations, 100 * penetration / solid_->presses().radius)});
    return result;
  }

  Result of_mesh(const Point& point) {
    Result result;
    Row rest = row(point);
    std::tie(rest.err_u_rel, rest.err_f_rel) = std::tuple_cat(solid_->fine_linear_rest());
    rest.reference = "fine_linear";
    result.rows.push_back(rest);
    return result;
  }

  std::shared_ptr<SolidCase> solid_;
  std::string name_;
};

}  // namespace

std::unique_ptr<Method> make_quasi_static(std::shared_ptr<SolidCase> solid) {
  return std::make_unique<QuasiStatic>(std::move(solid));
}
std::unique_ptr<Method> make_linearity(std::shared_ptr<SolidCase> solid) {
  return std::make_unique<Linearity>(std::move(solid));
}

}  // namespace palpate::study

#include "tools/study/catheter.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/study/insertion.hpp"
#include "tools/study/measure.hpp"
#include "tools/study/press_errors.hpp"

namespace palpate::study {
namespace {

constexpr double kPulled = 0.1;  // of its length, the tip aside
constexpr double kPullSeconds = 0.1, kPullCourseSeconds = 0.3, kRestSeconds = 3, kPullDamping = 40;
constexpr double kClamp = 0.02;                         // of its length, held at the tail by three points
constexpr double kStiff = 1e-6;                         // [m/N] of the grasps
constexpr int kPlaces = 60;                             // along its length, where shapes are compared
constexpr const char* kInsertionSuffix = " insertion";  // of the method in course.csv

Catheter& shape_of(Scene& scene, int body) {
  return std::get<CatheterSpec>(scene.bodies[body]).catheter;
}
const Catheter& shape_of(const Scene& scene, int body) {
  return std::get<CatheterSpec>(scene.bodies[body]).catheter;
}

/// What the tip's pull did.
struct Pulled {
  double force = 0;                    // [N] at the tip
  std::vector<Eigen::Vector3d> shape;  // [m] displacement of places along it
};

/// A catheter clamped at its tail and held at its tip.
class Rig {
 public:
  Rig(const Scene& scene, int body, double tick, double damping)
      : before_(bytes_in_use()), body_(settings(scene, body, tick, damping), nullptr) {
    bytes_ = bytes_in_use() - before_;
    const Catheter& shape = shape_of(scene, body);
    const Eigen::Vector3d along = (shape.tip - shape.tail).normalized();
    side_ = along.unitOrthogonal();
    length_ = (shape.tip - shape.tail).norm();
    tick_ = tick;
    rest_.assign(body_.positions().begin(), body_.positions().end());
    const double held = kClamp * length_;
    body_.grasp(0, Eigen::Isometry3d::Identity(), at(held), 2 * held, kStiff);
    body_.grasp(1, Eigen::Isometry3d::Identity(), at(length_), 0, kStiff);
  }

  /// One tick, at whose end the tip is `aside` [m]; force there [N].
  double step(double aside) {
    jaws_[1].translation() = aside * side_;
    body_.step({}, jaws_);
    return body_.load(1);
  }

  Pulled rest() {
    Pulled answer;
    for (double t = 0; t < kRestSeconds; t += tick_)
      answer.force = step(std::min(1.0, t / kPullSeconds) * kPulled * length_);
    for (int i = 1; i <= kPlaces; ++i) answer.shape.push_back(displacement(length_ * i / kPlaces));
    return answer;
  }

  /// Force at the tip and displacement of the middle at every `interval` [s].
  std::vector<std::array<double, 2>> course(double interval) {
    std::vector<std::array<double, 2>> path;
    const int ticks = static_cast<int>(std::lround(interval / tick_));
    for (int i = 1; i * tick_ < kPullCourseSeconds + 1e-12; ++i) {
      const double force = step(std::min(1.0, i * tick_ / kPullSeconds) * kPulled * length_);
      if (i % ticks == 0) path.push_back({force, displacement(length_ / 2).dot(side_)});
    }
    return path;
  }

  std::vector<double> time(int count) {
    return time_steps(200, count, [&](int i) { step(kPulled * length_ * (1 + 1e-3 * std::sin(0.05 * i))); });
  }
  std::size_t bytes() const { return bytes_; }

 private:
  static CatheterSettings settings(const Scene& scene, int body, double tick, double damping) {
    CatheterSettings s = catheter_settings(scene, body, tick);
    s.shape.sleeve = 0;
    s.shape.gravity.setZero();
    s.shape.damping = damping;
    return s;
  }

  ChainPoint at(double place) const {
    const double share = std::clamp(place / body_.spacing(), 0.0, static_cast<double>(body_.size() - 1));
    const int segment = std::min(static_cast<int>(share), body_.size() - 2);
    return {segment, share - segment};
  }

  Eigen::Vector3d displacement(double place) const {
    const ChainPoint p = at(place);
    const auto of = [&](int i) { return Eigen::Vector3d(body_.positions()[i] - rest_[i]); };
    return (1 - p.along) * of(p.segment) + p.along * of(p.segment + 1);
  }

  std::size_t before_, bytes_ = 0;
  CatheterBody body_;
  Eigen::Vector3d side_;
  double length_ = 0, tick_ = 0;
  std::vector<Eigen::Vector3d> rest_;
  std::array<Eigen::Isometry3d, 2> jaws_{Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity()};
};

class CatheterMethod : public Method {
 public:
  CatheterMethod(const Scene& scene, int body, bool quick)
      : scene_(scene),
        body_(body),
        quick_(quick),
        name_(scene.bodies.size() == 1 ? "catheter" : fmt::format("{}:catheter", name_of(scene.bodies[body]))) {
    if (!shape(scene).inside.empty()) insertion_.emplace(scene, body);
  }
  int body() const override { return body_; }

  std::vector<Point> points() const override {
    std::vector<Point> all;
    const auto add = [&](const std::string& knob, const std::string& value, const std::function<void(Scene&)>& change) {
      all.push_back({name_, knob, value, change, true});
    };
    add("scene", "as it is", [](Scene&) {});
    const int own = shape(scene_).particles;
    for (const double share : {0.25, 0.5, 2.0}) {
      const int particles = std::max(4, static_cast<int>(std::lround(share * own)));
      add("particles", std::to_string(particles),
          [b = body_, particles](Scene& s) { shape_of(s, b).particles = particles; });
    }
    const bool implicit = shape(scene_).integrator == ChainIntegrator::implicit;
    const ChainIntegrator other = implicit ? ChainIntegrator::semi_implicit : ChainIntegrator::implicit;
    add("integrator", std::string(word_of(other)), [b = body_, other](Scene& s) { shape_of(s, b).integrator = other; });
    for (const int ticks : {2, 4}) {
      if (quick_ && ticks != 2) continue;
      const double hz = ticks * scene_.rates.haptic_hz;
      all.push_back(
          {name_, "step", fmt::format("{:.3g} ms", 1e3 / hz), [hz](Scene& s) { s.rates.haptic_hz = hz; }, false});
    }
    if (insertion_) all.push_back({name_, "insertion reference", "coarser", {}, false});
    return all;
  }

  Result evaluate(const Point& point) override {
    if (!point.apply) return insertion_reference_rest(point);
    Scene scene = scene_;
    point.apply(scene);
    Row row{scene_.file.stem().string(), point.method, point.knob, point.value};
    const double tick = 1 / scene.rates.haptic_hz;
    Rig rig(scene, body_, tick, kPullDamping);
    row.memory_bytes = static_cast<double>(rig.bytes());
    row.offline_s = 0;
    const Pulled ours = rig.rest();
    const StepTime time = summarise(rig.time(quick_ ? 600 : 2400));
    row.step_us_median = 1e6 * time.median;
    row.step_us_p99 = 1e6 * time.p99;
    if (!reference_) find_reference();
    Result result;
    Row still = row;
    double difference = 0, size = 0;
    for (int i = 0; i < kPlaces; ++i) {
      difference += (ours.shape[i] - reference_->shape[i]).squaredNorm();
      size += reference_->shape[i].squaredNorm();
    }
    still.err_u_rel = std::sqrt(difference / size);
    still.err_f_rel = std::abs(ours.force / reference_->force - 1);
    still.reference = "finest_chain";
    result.rows.push_back(still);
    row.reference = "finest_chain_in_time";
    add_course(row, Rig(scene, body_, tick, shape(scene).damping).course(interval()), course_, interval(), result);
    if (insertion_) add_insertion(row, scene, tick, result);
    return result;
  }

 private:
  const Catheter& shape(const Scene& scene) const { return shape_of(scene, body_); }
  double interval() const { return 1 / scene_.rates.haptic_hz; }

  void find_reference() {
    Scene scene = scene_;
    Catheter& fine = shape_of(scene, body_);
    fine.particles = (quick_ ? 4 : 6) * fine.particles;
    fine.integrator = ChainIntegrator::implicit;
    const double tick = interval() / 8;
    course_ = Rig(scene, body_, tick, fine.damping).course(interval());
    reference_ = Rig(scene, body_, 4 * tick, kPullDamping).rest();
  }

  /// Depth and force on the wall over time; the step's time is then that of the catheter in the duct.
  void add_insertion(Row row, const Scene& scene, double tick, Result& result) {
    std::vector<double> seconds;
    const auto course = insertion_->course(scene, tick, interval(), &seconds);
    const StepTime time = summarise(std::move(seconds));
    row.step_us_median = 1e6 * time.median;
    row.step_us_p99 = 1e6 * time.p99;
    row.reference = "finest_insertion";
    const auto first = result.courses.size();
    add_course(row, course, insertion_course(), interval(), result);
    for (auto i = first; i < result.courses.size(); ++i) result.courses[i].method += kInsertionSuffix;
  }

  const std::vector<std::array<double, 2>>& insertion_course() {
    if (insertion_course_.empty()) insertion_course_ = finer_insertion(quick_ ? 3 : 4);
    return insertion_course_;
  }

  /// So many times the particles, in ticks smaller by twice as much.
  std::vector<std::array<double, 2>> finer_insertion(int times) const {
    Scene scene = scene_;
    Catheter& fine = shape_of(scene, body_);
    fine.particles = times * (fine.particles - 1) + 1;
    fine.integrator = ChainIntegrator::implicit;
    return insertion_->course(scene, interval() / (2 * times), interval());
  }

  Result insertion_reference_rest(const Point& point) {
    Result result;
    Row row{scene_.file.stem().string(), point.method, point.knob, point.value};
    row.reference = "finest_insertion";
    add_course(row, finer_insertion(2), insertion_course(), interval(), result);
    result.courses.clear();
    return result;
  }

  const Scene& scene_;
  int body_;
  bool quick_;
  std::string name_;
  std::optional<Insertion> insertion_;
  std::vector<std::array<double, 2>> insertion_course_;
  std::optional<Pulled> reference_;
  std::vector<std::array<double, 2>> course_;
};

}  // namespace

std::unique_ptr<Method> make_catheter(const Scene& scene, int body, bool quick) {
  return std::make_unique<CatheterMethod>(scene, body, quick);
}

}  // namespace palpate::study

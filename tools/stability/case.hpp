#pragma once
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/scene/scene.hpp"

/// Stiff and extreme cases, each with its outcome. A case is a list of points; each runs in a process of its own.
namespace palpate::stability {

enum class Outcome {
  stable,       ///< as asked, finite and bounded
  regularised,  ///< finite and bounded because something was softened, damped or limited; the note says by how much
  refused,      ///< not begun; the note gives the bound or the sentence
  failed,       ///< not a number, unbounded, crashed or hung: must not occur
};
const char* word_of(Outcome outcome);

/// What one point gave.
struct Result {
  Outcome outcome = Outcome::stable;
  double max_force = 0;      ///< [N] largest to the hand, or of the kind that the note names
  double energy_growth = 0;  ///< [J] most that the hand or the motion has gained; the note says of what if not the hand
  std::string note;
};

/// Fails the row where a value is beyond its bound, or is not a number, and says so in its note.
void hold(Result& row, const char* what, double value, double bound);

/// One value of one parameter. `run` throws std::runtime_error for what the product refuses; what else it throws, the
/// system's own errors among it, is a failure.
struct Point {
  std::string name, parameter, value;
  std::function<Result()> run;
  double limit = 60;  ///< [s] after which it has hung
};

struct Row {
  std::string name, parameter, value, outcome;
  double max_force = 0, energy_growth = 0;
  std::string note;
};

/// How much to run: the quick subset takes seconds.
struct Extent {
  bool quick = false;
};

/// The larger of two; not a number as soon as one of them is none.
inline double larger(double a, double b) {
  return a >= b || std::isnan(a) ? a : b;
}

/// The registry: every subject's points.
std::vector<Point> all_points(const Extent& extent);
/// What makes sense on a scene's own bodies and tools.
std::vector<Point> scene_points(const Scene& scene, const Extent& extent);

std::vector<Point> material_points(const Extent& extent);
std::vector<Point> geometry_points(const Extent& extent);
std::vector<Point> hold_points(const Extent& extent);
std::vector<Point> press_points(const Extent& extent);
std::vector<Point> dynamic_points(const Extent& extent);
std::vector<Point> moving_points(const Extent& extent);
std::vector<Point> cut_points(const Extent& extent);
std::vector<Point> curve_points(const Extent& extent);
std::vector<Point> hybrid_points(const Extent& extent);
std::vector<Point> shell_points(const Extent& extent);
std::vector<Point> catheter_points(const Extent& extent);
std::vector<Point> loop_points(const Extent& extent);

}  // namespace palpate::stability

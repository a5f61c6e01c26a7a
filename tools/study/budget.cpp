#include "tools/study/budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>

namespace palpate::study {
namespace {

constexpr double kQuiet = 1.5;  // medians

struct Offer {
  Point point;
  double median = 0, p99 = 0, error = -1;  // [s], [s], [1]
};

/// The headings of a scene's tables.
std::set<std::string> tables_of(const Scene& scene) {
  std::set<std::string> tables;
  std::istringstream text(to_toml(scene));
  for (std::string line; std::getline(text, line);)
    if (line.starts_with('[')) tables.insert(line);
  return tables;
}

bool keeps_tables(const Scene& scene, const Point& point) {
  Scene other = scene;
  point.apply(other);
  return std::ranges::includes(tables_of(other), tables_of(scene));
}

bool counts(const std::string& reference) {
  return reference == "fine_linear" || reference.starts_with("all_modes") || reference.starts_with("finest_");
}

/// A point's worst error over the references that count; none without all figures.
std::optional<Offer> offer_of(const Point& point, const Result& result) {
  Offer offer{point};
  for (const Row& row : result.rows) {
    const bool same = row.method == point.method && row.knob == point.knob && row.value == point.value;
    if (!same || !counts(row.reference)) continue;
    if (!std::isfinite(row.step_us_median + row.step_us_p99 + row.err_u_rel + row.err_f_rel)) return {};
    offer.median = std::max(offer.median, 1e-6 * row.step_us_median);
    offer.p99 = std::max(offer.p99, 1e-6 * row.step_us_p99);
    offer.error = std::max({offer.error, row.err_u_rel, row.err_f_rel});
  }
  return offer.error < 0 ? std::nullopt : std::optional(offer);
}

std::vector<Offer> offers(const Methods& methods, const Scene& scene, int body, const Result& result) {
  std::vector<Offer> all;
  for (const auto& method : methods) {
    if (method->body() != body) continue;
    for (const Point& point : method->points())
      if (point.apply && point.serves && keeps_tables(scene, point))
        if (const auto offer = offer_of(point, result)) all.push_back(*offer);
  }
  return all;
}

bool better(const Choice& a, const Choice& b) {
  return a.error < b.error || (a.error == b.error && a.median < b.median);
}

/// What a step may take [s].
struct Limits {
  double median, p99;
};

void search(const std::vector<std::vector<Offer>>& all, std::size_t body, const Choice& so_far, const Limits& limits,
            std::optional<Choice>& best) {
  if (body == all.size()) {
    if (!best || better(so_far, *best)) best = so_far;
    return;
  }
  for (const Offer& offer : all[body]) {
    Choice next = so_far;
    next.points.push_back(offer.point);
    next.median += offer.median;
    next.p99 += offer.p99;
    next.error = std::max(next.error, offer.error);
    if (next.median <= limits.median && next.p99 <= limits.p99) search(all, body + 1, next, limits, best);
  }
}

}  // namespace

bool is_quiet(const Result& result) {
  std::vector<double> ratios;
  for (const Row& row : result.rows)
    if (std::isfinite(row.step_us_p99)) ratios.push_back(row.step_us_p99 / row.step_us_median);
  const auto quiet = std::ranges::count_if(ratios, [](double r) { return r <= kQuiet; });
  return 2 * quiet >= std::ssize(ratios);
}

std::optional<Choice> choose(const Methods& methods, const Scene& scene, const Result& result, double budget) {
  std::vector<std::vector<Offer>> all;
  for (int b = 0; b < std::ssize(scene.bodies); ++b) all.push_back(offers(methods, scene, b, result));
  const Limits limits{budget, is_quiet(result) ? budget : std::numeric_limits<double>::infinity()};
  std::optional<Choice> best;
  search(all, 0, {}, limits, best);
  return best;
}

void write_choice(const Scene& scene, const Choice& choice, const std::filesystem::path& file) {
  Scene chosen = scene;
  for (const Point& point : choice.points) point.apply(chosen);
  std::ofstream out(file);
  out << to_toml(chosen);
  if (!out.flush()) throw std::runtime_error(fmt::format("{}: cannot be written", file.string()));
  out.close();
  if (scene_hash(load_scene(file)) != scene_hash(chosen))
    throw std::runtime_error(fmt::format("{}: is not read back as it was written", file.string()));
}

}  // namespace palpate::study

#include "tools/study/budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace palpate::study {
namespace {

struct Offer {
  Point point;
  double p99, error;  // [s], [1]
};

bool counts(const std::string& reference) {
  return reference == "fine_linear" || reference.starts_with("all_modes") || reference.starts_with("finest_");
}

/// A point's worst error over the references that count; none without all figures.
std::optional<Offer> offer_of(const Point& point, const Result& result) {
  Offer offer{point, 0, -1};
  for (const Row& row : result.rows) {
    const bool same = row.method == point.method && row.knob == point.knob && row.value == point.value;
    if (!same || !counts(row.reference)) continue;
    if (!std::isfinite(row.step_us_p99 + row.err_u_rel + row.err_f_rel)) return {};
    offer.p99 = std::max(offer.p99, 1e-6 * row.step_us_p99);
    offer.error = std::max({offer.error, row.err_u_rel, row.err_f_rel});
  }
  return offer.error < 0 ? std::nullopt : std::optional(offer);
}

std::vector<Offer> offers(const Methods& methods, int body, const Result& result) {
  std::vector<Offer> all;
  for (const auto& method : methods) {
    if (method->body() != body) continue;
    for (const Point& point : method->points())
      if (point.apply && point.serves)
        if (const auto offer = offer_of(point, result)) all.push_back(*offer);
  }
  return all;
}

bool better(const Choice& a, const Choice& b) {
  return a.error < b.error || (a.error == b.error && a.p99 < b.p99);
}

void search(const std::vector<std::vector<Offer>>& all, std::size_t body, const Choice& so_far, double budget,
            std::optional<Choice>& best) {
  if (body == all.size()) {
    if (!best || better(so_far, *best)) best = so_far;
    return;
  }
  for (const Offer& offer : all[body]) {
    if (so_far.p99 + offer.p99 > budget) continue;
    Choice next = so_far;
    next.points.push_back(offer.point);
    next.p99 += offer.p99;
    next.error = std::max(next.error, offer.error);
    search(all, body + 1, next, budget, best);
  }
}

}  // namespace

std::optional<Choice> choose(const Methods& methods, int bodies, const Result& result, double budget) {
  std::vector<std::vector<Offer>> all;
  for (int b = 0; b < bodies; ++b) all.push_back(offers(methods, b, result));
  std::optional<Choice> best;
  search(all, 0, {}, budget, best);
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

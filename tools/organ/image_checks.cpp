#include "tools/organ/image_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tools/organ/label_volume.hpp"

namespace palpate {
namespace {

constexpr double kOffPlace = 0.1;  // of a step between slices: places are written with few digits

std::string say_voxel(const GridShape& image, std::size_t at) {
  const auto [i, j, k] = image.voxel_of(at);
  return fmt::format("{},{},{}", i, j, k);
}

std::string say_value(double value) {
  return std::isnan(value) ? "nan" : fmt::format("{:.10g}", value);  // a sign of what is no number says nothing
}

std::string say_mm(const Eigen::Vector3d& x) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) mm", x.x(), x.y(), x.z());
}

/// The way along the normal from each slice to the next.
struct Steps {
  std::vector<Eigen::Vector3d> place;  ///< of the slices, along the normal
  std::vector<double> mm;              ///< behind each but the last
  double usual = 0;                    ///< the median [mm]

  int missing_behind(std::size_t slice) const { return static_cast<int>(std::lround(mm[slice] / usual)) - 1; }
  bool is_multiple(std::size_t slice) const {
    return std::abs(mm[slice] - (missing_behind(slice) + 1) * usual) < kOffPlace * usual;
  }
  std::size_t widest() const { return std::ranges::max_element(mm) - mm.begin(); }
  std::size_t oddest() const {
    return std::ranges::max_element(mm, {}, [&](double step) { return std::abs(step - usual); }) - mm.begin();
  }
};

Steps steps_of(const SlicePlaces& slices) {
  Steps steps{slices.first_mm, {}};
  const auto along = [&](const Eigen::Vector3d& x) { return slices.normal.dot(x); };
  std::ranges::stable_sort(steps.place, {}, along);
  for (std::size_t k = 1; k < steps.place.size(); ++k)
    steps.mm.push_back(along(steps.place[k]) - along(steps.place[k - 1]));
  std::vector<double> sorted = steps.mm;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::ranges::nth_element(sorted, middle);
  steps.usual = *middle;
  return steps;
}

void check_apart(const Steps& steps) {
  const double mean = (steps.place.back() - steps.place.front()).norm() / static_cast<double>(steps.mm.size());
  for (std::size_t k = 0; k < steps.mm.size(); ++k)
    if (!(steps.mm[k] > kOffPlace * mean))
      throw std::runtime_error(
          fmt::format("two of its {} slices lie at {}, one on the other: take the images of another time or kind out "
                      "of the folder",
                      steps.place.size(), say_mm(steps.place[k])));
}

/// Whether each slice lies where it would if all steps were the same.
bool are_same(const Steps& steps) {
  double whole = 0, at = 0;
  for (const double mm : steps.mm) whole += mm;
  const double step = whole / static_cast<double>(steps.mm.size());
  for (std::size_t k = 0; k < steps.mm.size(); ++k) {
    at += steps.mm[k];
    if (std::abs(at - static_cast<double>(k + 1) * step) > kOffPlace * step) return false;
  }
  return true;
}

[[noreturn]] void refuse(const Steps& steps) {
  const auto behind = [&](std::size_t k) {
    return fmt::format("between {} and {}", say_mm(steps.place[k]), say_mm(steps.place[k + 1]));
  };
  const std::size_t widest = steps.widest(), oddest = steps.oddest();
  if (steps.missing_behind(widest) < 1 || !steps.is_multiple(widest))
    throw std::runtime_error(
        fmt::format("its slices are not evenly spaced: {:.4g} mm {}, and {:.4g} mm elsewhere; resample it evenly",
                    steps.mm[oddest], behind(oddest), steps.usual));
  const std::string between = behind(widest);
  int all = 0;
  for (std::size_t k = 0; k < steps.mm.size(); ++k) all += std::max(0, steps.missing_behind(k));
  const int here = steps.missing_behind(widest);
  throw std::runtime_error(
      fmt::format("{} slice{} missing {}, where others lie {:.4g} mm apart{}: put {} into the folder, or resample it "
                  "evenly",
                  here, here == 1 ? " is" : "s are", between, steps.usual,
                  all > here ? fmt::format(", and {} more elsewhere", all - here) : "", all == 1 ? "it" : "them"));
}

void check_upright(const SlicePlaces& slices, const Steps& steps) {
  const auto aside = [&](const Eigen::Vector3d& x) {
    const Eigen::Vector3d way = x - steps.place.front();
    return (way - way.dot(slices.normal) * slices.normal).norm();
  };
  const double most = 0.5 * slices.pixel_mm, last = aside(steps.place.back());
  if (last > most)
    throw std::runtime_error(
        fmt::format("its slices lie aslant on one another, as of a tilted scanner: the last one, at {}, lies {:.4g} mm "
                    "beside the first one's normal; resample it upright",
                    say_mm(steps.place.back()), last));
  for (const Eigen::Vector3d& x : steps.place)
    if (aside(x) > most)
      throw std::runtime_error(
          fmt::format("its slice at {} lies {:.4g} mm beside the first one's normal, and the last "
                      "one does not: resample it upright",
                      say_mm(x), aside(x)));
}

}  // namespace

std::int32_t LabelTaker::take(double value, std::size_t at) {
  if (!(value >= static_cast<double>(kLeastLabel) && value <= static_cast<double>(kMostLabel) &&
        value == std::floor(value)))
    throw std::runtime_error(
        fmt::format("its value at voxel {} is {}, and labels are whole numbers from {} to {}: write them as such, or "
                    "make a label of grey values with `palpate segment`",
                    say_voxel(image_, at), say_value(value), kLeastLabel, kMostLabel));
  const auto label = static_cast<std::int64_t>(value);
  if (label < 0 && !negative_) negative_ = at;
  if (label > std::numeric_limits<std::int32_t>::max() && !high_) high_ = at;
  return static_cast<std::int32_t>(label);
}

bool LabelTaker::is_high() const {
  if (negative_ && high_)
    throw std::runtime_error(fmt::format(
        "its label at voxel {} is below 0 and that at voxel {} above {}: one or the other is read",
        say_voxel(image_, *negative_), say_voxel(image_, *high_), std::numeric_limits<std::int32_t>::max()));
  return high_.has_value();
}

void check_finite(const GridShape& image, const std::vector<float>& grey) {
  const auto bad = std::ranges::find_if_not(grey, [](float value) { return std::isfinite(value); });
  if (bad != grey.end())
    throw std::runtime_error(fmt::format("its value at voxel {} is {}, which is no finite number",
                                         say_voxel(image, bad - grey.begin()), say_value(*bad)));
}

void check_even(const SlicePlaces& slices) {
  if (slices.first_mm.size() < 2) return;
  const Steps steps = steps_of(slices);
  check_apart(steps);
  if (!are_same(steps)) refuse(steps);
  check_upright(slices, steps);
}

}  // namespace palpate

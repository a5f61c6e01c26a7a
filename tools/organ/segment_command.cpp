#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "tools/organ/commands.hpp"
#include "tools/organ/fineness_options.hpp"
#include "tools/organ/label_file.hpp"
#include "tools/organ/picture_folder.hpp"
#include "tools/organ/places.hpp"
#include "tools/organ/slice_pictures.hpp"

namespace palpate {
namespace {

constexpr double kSureEnough = 0.6;  // share of a slice's contour on an edge, below which it is worth a look

struct SegmentOptions {
  std::string image, series, output, range, points, preview;
  std::vector<std::string> seeds, seed_voxels;
  double smoothing = 1, neck = 0;
  bool json = false;
  ContourForces forces;
};

std::vector<double> three_of(const std::string& option, const std::string& text) {
  std::vector<double> numbers = numbers_of(text);
  if (numbers.size() != 3)
    throw std::runtime_error(fmt::format("{} {}: three numbers x,y,z are asked for", option, text));
  return numbers;
}

/// The voxel of a place given in voxels.
std::size_t voxel_at(const GridShape& shape, const Eigen::Vector3d& steps, const std::string& said) {
  const Eigen::Array3d voxel = steps.array().round();
  for (int a = 0; a < 3; ++a)
    if (!(voxel[a] >= 0 && voxel[a] < shape.count[a]))
      throw std::runtime_error(fmt::format("{} lies at voxel {:.4g},{:.4g},{:.4g}, outside of the image's {} x {} x {}",
                                           said, steps.x(), steps.y(), steps.z(), shape.count[0], shape.count[1],
                                           shape.count[2]));
  const Eigen::Array3i i = voxel.cast<int>();
  return shape.index(i[0], i[1], i[2]);
}

std::vector<std::size_t> seeds_of(const SegmentOptions& o, const GreyVolume& volume) {
  std::vector<std::size_t> seeds;
  for (const std::string& text : o.seeds) {
    const Eigen::Vector3d world = 1e-3 * Eigen::Vector3d(three_of("--seed", text).data());
    const Eigen::Vector3d x = volume.in_image(world) - volume.shape.origin;
    seeds.push_back(voxel_at(volume.shape, x.cwiseQuotient(volume.shape.spacing), "--seed " + text));
  }
  for (const std::string& text : o.seed_voxels)
    seeds.push_back(
        voxel_at(volume.shape, Eigen::Vector3d(three_of("--seed-voxel", text).data()), "--seed-voxel " + text));
  if (seeds.empty()) throw std::runtime_error("a --seed or --seed-voxel in the organ is asked for");
  return seeds;
}

void tell_seeds(const GreyVolume& volume, const std::vector<std::size_t>& seeds, Output& out) {
  out.figures()["seeds"] = Output::Json::array();
  for (const std::size_t seed : seeds) {
    const auto [i, j, k] = volume.shape.voxel_of(seed);
    out.say(fmt::format("  seed at voxel {},{},{}, of grey value {:.4g}", i, j, k, volume.value[seed]));
    out.figures()["seeds"].push_back({i, j, k});
  }
}

SegmentationRules rules_of(const SegmentOptions& o, const GridShape& shape) {
  SegmentationRules rules;
  rules.neck = 1e-3 * o.neck;
  rules.forces = o.forces;
  if (!o.range.empty()) {
    const std::vector<double> ends = numbers_of(o.range, ':');
    if (ends.size() != 2 || ends[0] > ends[1])
      throw std::runtime_error(fmt::format("--range {}: LOW:HIGH is asked for", o.range));
    rules.range = GreyRange{ends[0], ends[1]};
  }
  if (!o.points.empty()) rules.by_hand = read_hand_contours(o.points, shape);
  return rules;
}

/// Of what is written.
bool has_contours(const SegmentedSlice& slice) {
  return !slice.moved.empty() && slice.voxels > 0;
}

std::vector<int> doubtful_slices(const Segmentation& s) {
  std::vector<int> doubtful;
  for (std::size_t k = 0; k < s.slices.size(); ++k)
    if (has_contours(s.slices[k]) && s.slices[k].on_edge() < kSureEnough) doubtful.push_back(static_cast<int>(k));
  return doubtful;
}

/// "12, 30-34"
std::string runs_of(const std::vector<int>& slices) {
  std::string text;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const int first = slices[i];
    while (i + 1 < slices.size() && slices[i + 1] == slices[i] + 1) ++i;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", first);
    if (slices[i] > first) text += fmt::format("-{}", slices[i]);
  }
  return text;
}

void tell_contours(const SegmentOptions& o, const Segmentation& s, Output& out) {
  std::vector<int> slices;
  int by_hand = 0;
  double on_edge = 0;
  for (std::size_t k = 0; k < s.slices.size(); ++k) {
    if (!has_contours(s.slices[k])) continue;
    slices.push_back(static_cast<int>(k)), by_hand += s.slices[k].by_hand, on_edge += s.slices[k].on_edge();
  }
  if (slices.empty()) return;  // of a few voxels
  on_edge /= static_cast<double>(slices.size());
  const bool moved = o.forces.reach > 0;
  const std::vector<int> doubtful = moved ? doubtful_slices(s) : std::vector<int>{};
  out.say(fmt::format("  contours in slices {} to {}, {} of them by hand{}", slices.front(), slices.back(), by_hand,
                      moved ? fmt::format("; {:.0f} % of their points on an edge", 100 * on_edge) : ""));
  if (!doubtful.empty())
    out.say(fmt::format("  less than {:.0f} % in slices {}: look at them (--preview) and draw what is wrong (--points)",
                        100 * kSureEnough, runs_of(doubtful)));
  out.figures().update({{"first_slice", slices.front()},
                        {"last_slice", slices.back()},
                        {"slices_by_hand", by_hand},
                        {"points_on_edge", on_edge},
                        {"doubtful_slices", doubtful}});
}

/// A contour by hand that hangs on no seed's piece.
void warn_of_lost_contours(const Segmentation& s, Output& out) {
  std::vector<int> lost;
  for (std::size_t k = 0; k < s.slices.size(); ++k)
    if (s.slices[k].by_hand && s.slices[k].voxels == 0) lost.push_back(static_cast<int>(k));
  out.figures()["slices_by_hand_lost"] = lost;
  if (!lost.empty())
    out.warn(
        fmt::format("nothing is left of what is drawn by hand in slice{} {}: it does not hang together with the "
                    "seeds' piece; draw slices in between too, or give a seed in it",
                    lost.size() == 1 ? "" : "s", runs_of(lost)));
}

void tell_segmentation(const SegmentOptions& o, const GridShape& shape, const Segmentation& s, Output& out) {
  out.say(fmt::format("  range: {:.4g} to {:.4g}{}", s.range.low, s.range.high,
                      o.range.empty() ? ", from what lies around the seeds" : ""));
  out.figures()["range"] = {s.range.low, s.range.high};
  tell_findings(s.findings, "", out);
  tell_contours(o, s, out);
  warn_of_lost_contours(s, out);
  const auto voxels = std::ranges::count(s.inside, 1);
  const double volume = static_cast<double>(voxels) * shape.spacing.prod();
  out.say(fmt::format("{}: label 1, {} voxels, {:.4g} ml", o.output, voxels, 1e6 * volume));
  out.figures().update({{"file", o.output}, {"label", 1}, {"label_voxels", voxels}, {"volume_m3", volume}});
}

void segment_image(const SegmentOptions& o) {
  Output out(o.json);
  check_picture_folder(o.preview);
  say_progress("reading the image");
  GreyVolume volume = read_grey_volume(o.image, o.series);
  const GridShape& shape = volume.shape;
  tell_image(o.image, shape, out);
  const std::vector<std::size_t> seeds = seeds_of(o, volume);
  tell_seeds(volume, seeds, out);
  const SegmentationRules rules = rules_of(o, shape);
  const ScalarGrid image{shape, std::move(volume.value)};
  say_progress("smoothing");
  const SmoothedImage smoothed = smoothed_image(image, o.smoothing * shape.spacing.head<2>().minCoeff());
  say_progress("growing the region and moving contours");
  Segmentation segmentation = of_file(o.image, [&] { return segment(smoothed, seeds, rules); });
  if (!o.preview.empty()) {
    say_progress("drawing the slices");
    write_slice_pictures(image, smoothed.twiced, segmentation, o.preview);
  }
  write_label_volume(volume, segmentation.inside, o.output);
  for (Finding& finding : segmentation.findings)
    for (Eigen::Vector3d& x : finding.places) x = volume.in_world(x);
  tell_segmentation(o, shape, segmentation, out);
  out.finish();
}

}  // namespace

void add_segment_command(cli::Command& app) {
  cli::Command command = app.add_command(
      "segment", "Make a label of an organ's grey values, slice by slice (INR, NIfTI, MetaImage, NRRD, DICOM)");
  auto o = std::make_shared<SegmentOptions>();
  command.add_option("IMAGE", o->image, "Image file of grey values, or a folder with a DICOM series").required();
  command.add_option("--series", o->series, kSeriesHelp);
  command.add_option("-o,--output", o->output, "Labels to write (.mha, .nrrd; .inr keeps no origin)")
      .required()
      .output_file("", {".inr", ".mha", ".nrrd"});
  command
      .add_option(
          "--seed", o->seeds,
          "Point in the organ: x,y,z in the image's world [mm], to the left, back and head as DICOM has it (the first "
          "two of NIfTI's own with the other sign); may be given again")
      .one_value_each_time();
  command.add_option("--seed-voxel", o->seed_voxels, "The same in voxels, from 0; may be given again")
      .one_value_each_time();
  command.add_option("--range", o->range, "Grey values of the organ, LOW:HIGH (default: from the seeds' surroundings)");
  command.add_option("--smoothing", o->smoothing, "Deviation of the Gaussian that smooths, in voxels of a slice")
      .between(0.0, 5.0)
      .show_default();
  command.add_option("--neck", o->neck, "Cut off what hangs on the region by less than this [mm]").positive();
  command.add_option("--reach", o->forces.reach, "How far contours look for edges, in voxels; 0: they stay")
      .between(0.0, 20.0)
      .show_default();
  command.add_option("--stiffness", o->forces.stiffness, "Of contours against bending")
      .between(0.0, 1000.0)
      .show_default();
  command.add_option("--points", o->points,
                     "Text file of lines SLICE X Y, in voxels: the contours of these slices are drawn through their "
                     "points, those of up to 15 slices between two of them start from both");
  command.add_option("--preview", o->preview, "Folder for a picture of each slice with its contours");
  command.add_flag("--json", o->json, "Print one line of JSON");
  command.tells_progress();
  command.examples({"palpate segment ct.nii.gz --seed 60,-20,110 --preview slices -o liver.mha",
                    "palpate segment ct.nii.gz --seed 60,-20,110 --neck 6 --points mended.txt -o liver.mha"});
  command.does([o] { segment_image(*o); });
}

}  // namespace palpate

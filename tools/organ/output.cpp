#include "tools/organ/output.hpp"

#include <fmt/format.h>

#include "common/describe/printable.hpp"
#include "tools/organ/label_volume.hpp"

namespace palpate {

void Output::say(const std::string& line) const {
  if (json_) return;
  fmt::print("{}\n", printable(line));
  std::fflush(stdout);
}

void Output::warn(const std::string& sentence) {
  say("warning: " + sentence);
  warnings_.push_back(sentence);
}

void Output::finish() const {
  if (!json_) return;
  Json all = figures_;
  all["warnings"] = warnings_;
  fmt::print("{}\n", all.dump(-1, ' ', false, Json::error_handler_t::replace));
}

void tell_image(const std::string& file, const GridShape& shape, Output& out) {
  out.say(fmt::format("{}: {}", file, say_size(shape)));
  out.figures()["image"] = file;
  out.figures()["voxels"] = shape.count;
  out.figures()["voxel_m"] = {shape.spacing.x(), shape.spacing.y(), shape.spacing.z()};
}

}  // namespace palpate

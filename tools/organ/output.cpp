#include "tools/organ/output.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

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

void check_folder_of(const std::string& file) {
  if (file.empty()) return;
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  if (!std::filesystem::is_directory(folder))
    throw std::runtime_error(fmt::format("{}: it cannot be written, since the folder {} is not there", printable(file),
                                         printable(folder.string())));
}

void tell_image(const std::string& file, const GridShape& shape, Output& out) {
  out.say(fmt::format("{}: {}", file, say_size(shape)));
  out.figures()["image"] = file;
  out.figures()["voxels"] = shape.count;
  out.figures()["voxel_m"] = {shape.spacing.x(), shape.spacing.y(), shape.spacing.z()};
}

}  // namespace palpate

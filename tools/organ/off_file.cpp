#include "tools/organ/off_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "common/describe/printable.hpp"
#include "tools/organ/word_lines.hpp"

namespace palpate {
namespace {

class OffPolygons {
 public:
  explicit OffPolygons(std::string_view bytes) : lines_(bytes) {}

  Polygons read() {
    take_kind();
    const std::size_t points = take_count("vertices"), polygons = take_count("faces");
    end_line();  // a count of edges, which nobody keeps
    for (std::size_t i = 0; i < points; ++i) take_point(i, points);
    end_line();
    for (std::size_t i = 0; i < polygons; ++i) take_polygon(i, polygons);
    return std::move(read_);
  }

 private:
  /// The first word says what a vertex has beside its place: "ST", "C" and "N" stand before "OFF".
  void take_kind() {
    lines_.next();
    find_word("its first line");
    std::string_view kind = lines_.word();
    const std::string_view whole = kind;
    for (const std::string_view more : {"ST", "C", "N"})
      if (kind.starts_with(more)) kind.remove_prefix(more.size()), with_more_ = true;
    if (kind != "OFF")
      lines_.refuse(fmt::format("\"{}\" stands where OFF should, or COFF, NOFF or STOFF: others are not read",
                                printable(whole.substr(0, 20))));
    WordLines ahead = lines_;
    if (ahead.word() == "BINARY") lines_.refuse("OFF files of bytes are not read: save it as text");
  }

  std::size_t take_count(const char* things) {
    const double count = next_number(things);
    if (!(count >= 0 && count <= static_cast<double>(lines_.left()) && std::floor(count) == count))
      lines_.refuse(fmt::format("the file announces {} {}, which it is too short to hold", count, things));
    return static_cast<std::size_t>(count);
  }

  void take_point(std::size_t i, std::size_t all) {
    const std::string which = fmt::format("vertex {} of {}", i, all);
    Eigen::Vector3d place;
    for (double& x : place) x = next_number(which);
    read_.points.push_back(place);
    if (with_more_) end_line();
  }

  /// Behind its corners a face may have a colour.
  void take_polygon(std::size_t i, std::size_t all) {
    const std::string which = fmt::format("face {} of {}", i, all);
    std::vector<int>& polygon = read_.polygons.emplace_back();
    for (std::size_t left = take_count("corners of a face"); left > 0; --left) {
      const double n = next_number(which);
      if (!(n >= 0 && n < static_cast<double>(read_.points.size()) && std::floor(n) == n))
        lines_.refuse(fmt::format("{} names vertex {}, of {}", which, n, read_.points.size()));
      polygon.push_back(static_cast<int>(n));
    }
    end_line();
  }

  /// On this line or one that follows.
  double next_number(const std::string& which) {
    find_word(which);
    return lines_.number();
  }

  void find_word(const std::string& which) {
    for (WordLines ahead = lines_; ahead.word().empty(); ahead = lines_)
      if (!lines_.next()) throw std::runtime_error(fmt::format("the file ends before {}", which));
  }

  void end_line() {
    while (!lines_.word().empty()) {
    }
  }

  WordLines lines_;
  bool with_more_ = false;
  Polygons read_;
};

}  // namespace

Polygons read_off(std::string_view bytes) {
  return OffPolygons(bytes).read();
}

}  // namespace palpate

#include "tools/organ/obj_polygons.hpp"

#include <fmt/format.h>

#include <charconv>
#include <set>
#include <string>

#include "common/describe/printable.hpp"
#include "tools/organ/word_lines.hpp"

namespace palpate {
namespace {

class ObjPolygons {
 public:
  explicit ObjPolygons(std::string_view bytes) : lines_(bytes) {}

  Polygons read(std::vector<Finding>& findings) {
    while (lines_.next())
      if (const std::string_view key = lines_.word(); !key.empty()) take_line(key);
    check_corners();
    note_others(findings);
    note_groups(findings);
    return std::move(read_);
  }

 private:
  void take_line(std::string_view key) {
    static const std::set<std::string_view> passed{"vn", "vt", "vp", "o", "s", "mg", "mtllib", "usemtl"};
    if (key == "v") return take_vertex();
    if (key == "f") return take_face();
    if (key == "g") return take_group();
    if (passed.contains(key)) return;
    if (others_++ == 0) first_other_ = fmt::format("{}, '{}'", lines_.line(), printable(key.substr(0, 20)));
  }

  /// A weight or a colour may stand behind the coordinates.
  void take_vertex() {
    Eigen::Vector3d place;
    for (double& x : place) x = lines_.number();
    read_.points.push_back(place);
    while (more()) lines_.number();
  }

  bool more() {
    WordLines ahead = lines_;
    return !ahead.word().empty();
  }

  void take_face() {
    face_lines_.push_back(lines_.line());
    std::vector<int>& face = read_.polygons.emplace_back();
    for (std::string_view word = lines_.word(); !word.empty(); word = lines_.word()) face.push_back(corner(word));
    if (face.size() < 3) lines_.refuse(fmt::format("a face has {} corners, and needs 3", face.size()));
  }

  /// "7", "7/2", "7/2/5" or "7//5"; from 1, or backwards from -1.
  int corner(std::string_view word) {
    const std::string_view text = word.substr(0, word.find('/'));
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size())
      lines_.refuse(fmt::format("\"{}\" stands where a face's corner should", printable(word.substr(0, 20))));
    const auto known = static_cast<int>(read_.points.size());
    if (number == 0 || number < -known)
      lines_.refuse(fmt::format("a face names vertex {}, of {} above it", number, known));
    return number < 0 ? known + number : number - 1;
  }

  /// Faces may stand above their vertices.
  void check_corners() const {
    for (std::size_t f = 0; f < read_.polygons.size(); ++f)
      for (const int n : read_.polygons[f])
        if (static_cast<std::size_t>(n) >= read_.points.size())
          lines_.refuse_at(face_lines_[f], fmt::format("a face names vertex {}, of {}", n + 1, read_.points.size()));
  }

  void take_group() {
    const std::string_view name = lines_.word();
    if (!name.empty() && groups_.emplace(name).second && groups_.size() == 1) first_group_ = name.substr(0, 40);
  }

  void note_others(std::vector<Finding>& findings) const {
    if (others_ > 0)
      findings.push_back(
          {fmt::format("lines that say nothing of polygons ({}), the first line {}", others_, first_other_),
           "passed over",
           {}});
  }

  void note_groups(std::vector<Finding>& findings) const {
    if (!groups_.empty())
      findings.push_back({fmt::format("groups of triangles ({}), the first '{}'", groups_.size(), first_group_),
                          "not kept: --group names nodes by their place",
                          {}});
  }

  WordLines lines_;
  Polygons read_;
  std::vector<int> face_lines_;
  int others_ = 0;
  std::set<std::string> groups_;
  std::string first_other_, first_group_;
};

}  // namespace

Polygons read_obj_polygons(std::string_view bytes, std::vector<Finding>& findings) {
  return ObjPolygons(bytes).read(findings);
}

}  // namespace palpate

#include "tools/study/result.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "common/files/atomic_file.hpp"

namespace palpate::study {

const char* const kStudyHead =
    "scene,method,knob,value,step_us_median,step_us_p99,offline_s,memory_bytes,err_u_rel,err_f_rel,reference";

namespace {

const char* const kDepthHead =
    "scene,method,knob,value,patch,depth_m,depth_per_radius,force_N,reference_force_N,err_u_rel,err_f_rel,"
    "reference,x_m,y_m,z_m,nx,ny,nz,node";
const char* const kCourseHead =
    "scene,method,knob,value,time_s,force_N,reference_force_N,displacement_m,reference_displacement_m";
const char* const kSlideHead = "scene,method,knob,value,friction,path_m,force_N,tangential_N,reference_force_N";
const char* const kTouchHead = "scene,method,knob,value,friction,mean_force_N,ripple,jump,turn,buzz,spread";
const char* const kNoteHead = "scene,method,knob,value,text";

std::string cell(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}
std::string cells(const std::array<double, 3>& values) {
  return cell(values[0]) + "," + cell(values[1]) + "," + cell(values[2]);
}
double number(const std::string& cell) {
  return cell.empty() ? kUnknown : std::stod(cell);
}

/// Text that is one cell: no comma, quote or line break.
std::string cell(std::string text) {
  for (char& c : text) c = c == '"' ? '\'' : c == ',' || c == '\n' ? ';' : c;
  return text;
}

std::string line(const Row& r) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{}", cell(r.scene), cell(r.method), cell(r.knob), cell(r.value),
                     cell(r.step_us_median), cell(r.step_us_p99), cell(r.offline_s), cell(r.memory_bytes),
                     cell(r.err_u_rel), cell(r.err_f_rel), cell(r.reference));
}

std::string line(const DepthRow& r) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", cell(r.scene), cell(r.method), cell(r.knob),
                     cell(r.value), r.patch, cell(r.depth_m), cell(r.depth_per_radius), cell(r.force_N),
                     cell(r.reference_force_N), cell(r.err_u_rel), cell(r.err_f_rel), cell(r.reference), cells(r.point),
                     cells(r.normal), r.node);
}

std::string line(const CourseRow& r) {
  return fmt::format("{},{},{},{},{},{},{},{},{}", cell(r.scene), cell(r.method), cell(r.knob), cell(r.value),
                     cell(r.time_s), cell(r.force_N), cell(r.reference_force_N), cell(r.displacement_m),
                     cell(r.reference_displacement_m));
}

std::string line(const SlideRow& r) {
  return fmt::format("{},{},{},{},{},{},{},{},{}", cell(r.scene), cell(r.method), cell(r.knob), cell(r.value),
                     cell(r.friction), cell(r.path_m), cell(r.force_N), cell(r.tangential_N),
                     cell(r.reference_force_N));
}

std::string line(const TouchRow& r) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{}", cell(r.scene), cell(r.method), cell(r.knob), cell(r.value),
                     cell(r.friction), cell(r.mean_force_N), cell(r.ripple), cell(r.jump), cell(r.turn), cell(r.buzz),
                     cell(r.spread));
}

std::string line(const Note& n) {
  return fmt::format("{},{},{},{},{}", cell(n.scene), cell(n.method), cell(n.knob), cell(n.value), cell(n.text));
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> cells{""};
  for (const char c : text) c == ',' ? cells.emplace_back() : cells.back() += c, void();
  return cells;
}

template <class Item>
void write_table(const std::filesystem::path& file, const char* head, const std::vector<Item>& items) {
  std::ofstream out(file);
  out << head << '\n';
  for (const Item& item : items) out << line(item) << '\n';
  if (!out.flush()) throw std::runtime_error(fmt::format("{}: cannot be written", file.string()));
}

}  // namespace

void append(Result& to, const Result& from) {
  to.rows.insert(to.rows.end(), from.rows.begin(), from.rows.end());
  to.depths.insert(to.depths.end(), from.depths.begin(), from.depths.end());
  to.courses.insert(to.courses.end(), from.courses.begin(), from.courses.end());
  to.slides.insert(to.slides.end(), from.slides.begin(), from.slides.end());
  to.touches.insert(to.touches.end(), from.touches.begin(), from.touches.end());
  to.notes.insert(to.notes.end(), from.notes.begin(), from.notes.end());
}

void write_result(const Result& result, const std::filesystem::path& folder) {
  write_table(folder / "study.csv", kStudyHead, result.rows);
  write_table(folder / "depth.csv", kDepthHead, result.depths);
  write_table(folder / "course.csv", kCourseHead, result.courses);
  write_table(folder / "slide.csv", kSlideHead, result.slides);
  write_table(folder / "touch.csv", kTouchHead, result.touches);
  write_table(folder / "notes.csv", kNoteHead, result.notes);
}

void write_fragment(const Result& result, const std::filesystem::path& file) {
  AtomicFile whole(file);
  std::ofstream out(whole.handle());
  for (const Row& r : result.rows) out << "study," << line(r) << '\n';
  for (const DepthRow& r : result.depths) out << "depth," << line(r) << '\n';
  for (const CourseRow& r : result.courses) out << "course," << line(r) << '\n';
  for (const SlideRow& r : result.slides) out << "slide," << line(r) << '\n';
  for (const TouchRow& r : result.touches) out << "touch," << line(r) << '\n';
  for (const Note& r : result.notes) out << "note," << line(r) << '\n';
  out << "end\n";
  if (!out.flush()) throw std::runtime_error(fmt::format("{}: cannot be written", file.string()));
  whole.commit();
}

Result read_fragment(const std::filesystem::path& file) {
  std::ifstream in(file);
  Result result;
  bool whole = false;
  for (std::string text; std::getline(in, text);) {
    auto c = split(text);
    whole |= text == "end";
    if (whole) break;
    const std::string kind = c.front();
    c.erase(c.begin());
    if (kind == "study" && c.size() == 11)
      result.rows.push_back({c[0], c[1], c[2], c[3], number(c[4]), number(c[5]), number(c[6]), number(c[7]),
                             number(c[8]), number(c[9]), c[10]});
    else if (kind == "depth" && c.size() == 19)
      result.depths.push_back({c[0],
                               c[1],
                               c[2],
                               c[3],
                               std::stoi(c[4]),
                               number(c[5]),
                               number(c[6]),
                               number(c[7]),
                               number(c[8]),
                               number(c[9]),
                               number(c[10]),
                               c[11],
                               {number(c[12]), number(c[13]), number(c[14])},
                               {number(c[15]), number(c[16]), number(c[17])},
                               std::stoi(c[18])});
    else if (kind == "course" && c.size() == 9)
      result.courses.push_back(
          {c[0], c[1], c[2], c[3], number(c[4]), number(c[5]), number(c[6]), number(c[7]), number(c[8])});
    else if (kind == "slide" && c.size() == 9)
      result.slides.push_back(
          {c[0], c[1], c[2], c[3], number(c[4]), number(c[5]), number(c[6]), number(c[7]), number(c[8])});
    else if (kind == "touch" && c.size() == 11)
      result.touches.push_back({c[0], c[1], c[2], c[3], number(c[4]), number(c[5]), number(c[6]), number(c[7]),
                                number(c[8]), number(c[9]), number(c[10])});
    else if (kind == "note" && c.size() == 5)
      result.notes.push_back({c[0], c[1], c[2], c[3], c[4]});
    else
      throw std::runtime_error(fmt::format("{}: not a part of a study", file.string()));
  }
  if (!whole) throw std::runtime_error(fmt::format("{}: not whole", file.string()));
  return result;
}

}  // namespace palpate::study

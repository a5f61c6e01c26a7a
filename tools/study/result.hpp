#pragma once
#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace palpate::study {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();  ///< an empty cell

extern const char* const kStudyHead;  ///< first line of study.csv

/// One line of study.csv: what one setting of one knob of a method costs and how wrong it is, everything else
/// being as the scene has it.
struct Row {
  std::string scene, method, knob, value;
  double step_us_median = kUnknown, step_us_p99 = kUnknown;  ///< [us] of a run-time step in contact
  double offline_s = kUnknown;                               ///< [s] before the run
  double memory_bytes = kUnknown;                            ///< that the method holds at run time
  double err_u_rel = kUnknown, err_f_rel = kUnknown;         ///< [1] against the reference
  std::string reference;                                     ///< empty: refused, see notes.csv
};

/// One line of depth.csv: one press.
struct DepthRow {
  std::string scene, method, knob, value;
  int patch = 0;
  double depth_m = 0, depth_per_radius = 0;
  double force_N = 0, reference_force_N = 0;  ///< along the press
  double err_u_rel = 0, err_f_rel = 0;
  std::string reference;
  std::array<double, 3> point{}, normal{};  ///< [m] where it pressed, and [1] out of the surface there
  int node = 0;                             ///< of the mesh, the nearest one
};

/// One line of course.csv: a moment of a press in motion.
struct CourseRow {
  std::string scene, method, knob, value;
  double time_s = 0;
  double force_N = 0, reference_force_N = 0;
  double displacement_m = 0, reference_displacement_m = 0;  ///< of the pressed place, along the press
};

/// One line of slide.csv: a tick of a slide.
struct SlideRow {
  std::string scene, method, knob, value;
  double friction = 0, path_m = 0;  ///< negative in the run-up
  double force_N = 0;
  double tangential_N = 0;       ///< on the tool, along its motion
  double reference_force_N = 0;  ///< without friction
};

/// One line of touch.csv: how a slide feels. See SlideMeasures.
struct TouchRow {
  std::string scene, method, knob, value;
  double friction = kUnknown, mean_force_N = kUnknown;
  double ripple = kUnknown, jump = kUnknown, turn = kUnknown, buzz = kUnknown;
  double spread = kUnknown;  ///< over presses at places all over the patches' triangles
};

/// A sentence that belongs to a row, or to the scene as a whole (empty method).
struct Note {
  std::string scene, method, knob, value, text;
};

/// What one point of the sweep gave.
struct Result {
  std::vector<Row> rows;
  std::vector<DepthRow> depths;
  std::vector<CourseRow> courses;
  std::vector<SlideRow> slides;
  std::vector<TouchRow> touches;
  std::vector<Note> notes;
};

void append(Result& to, const Result& from);

/// Writes study.csv, depth.csv, course.csv, slide.csv, touch.csv and notes.csv into a folder.
void write_result(const Result& result, const std::filesystem::path& folder);
/// One file that holds all of it, written beside and renamed: whole or absent.
void write_fragment(const Result& result, const std::filesystem::path& file);
/// Throws std::runtime_error on a file that write_fragment() has not written.
Result read_fragment(const std::filesystem::path& file);

}  // namespace palpate::study

#include "tools/film/log_report.hpp"

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/models/marked_to_resect.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/scene/find_archive.hpp"
#include "idl/topics.hpp"
#include "render_node/renderer.hpp"
#include "tools/film/log_figures.hpp"
#include "tools/film/log_pictures.hpp"
#include "tools/logs/log_files.hpp"
#include "tools/study/output_folder.hpp"
#include "tools/study/run_script.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream out(file);
  if (!(out << text).flush()) throw std::runtime_error(fmt::format("{}: cannot be written", file.string()));
}

constexpr const char* kCourseHead = "time,tool,x,y,z,force\n";

std::string course_name(std::size_t session) {
  return fmt::format("course_{}.csv", session);
}
std::string picture_name(std::size_t session, std::size_t picture) {
  return fmt::format("picture_{}_{}.png", session, picture);
}

/// Those that are written after the first course.
std::vector<std::string> other_files(const LogReportSettings& s) {
  std::vector<std::string> names{"report.json", "index.html"};
  for (std::size_t i = 0; i < s.logs.size(); ++i) {
    names.push_back(course_name(i));
    for (int k = 0; k < s.pictures; ++k) names.push_back(picture_name(i, k));
  }
  return names;
}

/// A report that does not come to its end leaves nothing that looks like one.
class Unfinished {
 public:
  /// Before there is a folder.
  explicit Unfinished(const LogReportSettings& settings) : settings_(settings), makes_(!fs::exists(settings.folder)) {}
  ~Unfinished() {
    std::error_code ignored;
    if (begun_) {
      fs::remove(settings_.folder / course_name(0), ignored);
      for (const std::string& name : other_files(settings_)) fs::remove(settings_.folder / name, ignored);
    }
    if (makes_) fs::remove(settings_.folder, ignored);  // where nothing else is in it
  }
  Unfinished(const Unfinished&) = delete;
  void begin() { begun_ = true; }
  void end() { begun_ = makes_ = false; }

 private:
  const LogReportSettings& settings_;
  bool makes_;
  bool begun_ = false;
};

void write_course(const fs::path& file, const LogFigures& figures, const Scene& scene) {
  std::string text = kCourseHead;
  for (const LogFigures::Place& p : figures.course())
    text += fmt::format("{:.4f},{},{:.5f},{:.5f},{:.5f},{:.5g}\n", p.time - figures.scene_begin(),
                        scene.tools[p.tool].name, p.tip.x(), p.tip.y(), p.tip.z(), p.force);
  write_text(file, text);
}

/// The times of `count` pictures [s], from the scene's first step on: the middles of as many parts of the session.
std::vector<double> picture_times(const LogContents& contents, int count) {
  const double first = std::max(0.0, -contents.scene_begin), last = contents.seconds - contents.scene_begin;
  std::vector<double> times;
  for (int i = 0; i < count; ++i) times.push_back(first + (last - first) * (i + 0.5) / count);
  return times;
}

ordered_json draw(const LogReportSettings& s, std::size_t session, const LoggedScene& logged) {
  ordered_json drawn = ordered_json::array();
  if (s.pictures == 0) return drawn;
  logged.ensure_archives();
  const LogContents contents = contents_of(s.logs[session], logged.scene());
  LogPictures pictures(s.logs[session], contents, logged.scene());
  const Render picture = logged.scene().render.value_or(Render{});
  constexpr int kWidth = 480;
  Renderer renderer(kWidth, kWidth * picture.height / picture.width, 4);
  Image image;
  for (const double time : picture_times(contents, s.pictures)) {
    stop_if_interrupted();
    Frame frame = pictures.at(time);
    frame.overlay = {};  // too small to read
    renderer.draw(frame, image);
    const std::string name = picture_name(session, drawn.size());
    write_png(image, s.folder / name);
    drawn.push_back({{"time", time}, {"file", name}});
  }
  return drawn;
}

std::map<std::uint32_t, Resection> resections_of(const LoggedScene& logged) {
  std::map<std::uint32_t, Resection> all;
  for (std::size_t b = 0; b < logged.scene().bodies.size(); ++b) {
    const Body& body = logged.scene().bodies[b];
    const Box* marked = marked_to_resect(body);
    if (!marked) continue;
    logged.ensure_archives();
    const Archive archive = find_archive(logged.scene(), body, ArchivePart::header);
    all.emplace(static_cast<std::uint32_t>(b), Resection(*marked, elastic_mesh(archive)));
  }
  return all;
}

/// What the log is known to lack, in sentences; empty where that is nothing.
std::string damage_of(const LogReader& reader, const LogFigures& figures) {
  std::string text = reader.damage_text();
  if (figures.missing() > 0)
    text += fmt::format("{}{} steps of the tools are not in the log; figures and curves are of the others",
                        text.empty() ? "" : "; ", figures.missing());
  return text;
}

ordered_json report_of(const LogReportSettings& s, std::size_t session, Unfinished& unfinished,
                       std::vector<std::string>& lacks) {
  const LoggedScene logged(s.logs[session], s.data);
  logged.require_one_run();
  const Scene& scene = logged.scene();
  LogFigures figures(scene, resections_of(logged));
  LogReader reader(s.logs[session]);
  for (LogEvent event; reader.next(event);) {
    stop_if_interrupted();
    figures.look(event);
  }
  figures.finish();
  if (!figures.has_forces())
    lacks.push_back(fmt::format("{}: it holds no sample of {}: what is reported of forces is none that was felt",
                                s.logs[session], topics::force_state.name));
  const std::string damage = damage_of(reader, figures);
  if (!damage.empty()) lacks.push_back(fmt::format("{}: {}", s.logs[session], damage));
  const std::string course = course_name(session);
  unfinished.begin();
  write_course(s.folder / course, figures, scene);
  ordered_json report{{"log", s.logs[session]},
                      {"title", scene.title.empty() ? scene.file.stem().string() : scene.title},
                      {"damage", damage},
                      {"course", course}};
  report.update(figures.json());
  report["pictures"] = draw(s, session, logged);
  return report;
}

}  // namespace

std::vector<std::string> report_logs(const LogReportSettings& s,
                                     const std::function<void(const std::string&)>& progress) {
  Unfinished unfinished(s);
  prepare_folder(s.folder, {course_name(0), kCourseHead}, other_files(s));
  ordered_json all{{"sessions", ordered_json::array()}};
  std::vector<std::string> lacks;
  for (std::size_t i = 0; i < s.logs.size(); ++i) {
    progress(s.logs[i]);
    all["sessions"].push_back(report_of(s, i, unfinished, lacks));
  }
  write_text(s.folder / "report.json", all.dump(2) + "\n");
  if (const std::string page = run_script("report_page.py", s.folder); !page.empty()) lacks.push_back(page);
  unfinished.end();
  return lacks;
}

}  // namespace palpate

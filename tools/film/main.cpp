#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/cli/command_line.hpp"
#include "common/cli/progress.hpp"
#include "common/realtime/shutdown.hpp"
#include "tools/film/log_film.hpp"
#include "tools/film/log_report.hpp"
#include "tools/film/path_picture.hpp"

namespace palpate {
namespace {

struct FilmOptions : LogFilmSettings {
  bool json = false;
};

void make_film(const FilmOptions& settings) {
  catch_shutdown_signals();
  const LogFilmReport report = film_log(settings, [&](long done, long due) {
    if (done % 10 == 0) cli::say_in_place(fmt::format("{} of {} pictures", done, due));
    return !shutdown_requested();
  });
  cli::say_in_place("");
  if (!report.damage.empty()) fmt::print(stderr, "palpate: {}\n", report.damage);
  const nlohmann::ordered_json figures{{"film", settings.film},
                                       {"pictures", report.frames},
                                       {"seconds", report.seconds},
                                       {"force_max_n", report.peak_force}};
  if (settings.json)
    fmt::print("{}\n", figures.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  else
    fmt::print("{}: {} pictures, {:.2f} s, largest force {:.2f} N\n", settings.film, report.frames, report.seconds,
               report.peak_force);
}

void add_film_command(cli::Command& app) {
  cli::Command command = app.add_command(
      "film", "Draw a topic log: every picture that is due, faster or slower than it was, the same bytes each time");
  auto s = std::make_shared<FilmOptions>();
  command.add_option("LOG", s->log, "Topic log").required();
  command.add_option("-o,--output", s->film, "Film (MP4)").required().output_file(".mp4");
  command.add_option("--still", s->still, "Picture (PNG) of the moment of the greatest force").output_file(".png");
  command.add_option("--from", s->from, "Begin there [s], from the scene's first step on")
      .between(0.0, 1e6)
      .show_default();
  command.add_option("--to", s->to, "End there [s] (default: with the log)").positive();
  command.add_option("--speed", s->speed, "2 shows it twice as fast").between(1e-4, 1e4).show_default();
  command.add_option("--rate", s->rate, "Pictures per second of the film").between(1.0, 240.0).show_default();
  command.add_option("--width", s->width, "Of the film [pixel] (default: the scene's)").between(16, 8192);
  command.add_option("--height", s->height, "Of the film [pixel] (default: the scene's)").between(16, 8192);
  command.add_option("--samples", s->samples, "Samples per pixel: 4 smooths edges and takes twice the time")
      .one_of({1, 4})
      .show_default();
  command.add_option("--data", s->data,
                     "Folder for the files that the log brings along, and with those that are too large for it");
  command.add_flag("--json", s->json, "Print one line of JSON");
  command.tells_progress();
  command.examples({"palpate film out/liver.lcmlog --speed 0.25 --from 2 --to 4 -o out/slow.mp4"});
  command.does([s] { make_film(*s); });
}

void add_report_command(cli::Command& app) {
  cli::Command command =
      app.add_command("report", "A page of sessions: force and path, pictures, and figures by which trainers compare");
  auto s = std::make_shared<LogReportSettings>();
  command.add_option("LOG", s->logs, "Topic logs, which are set side by side").required();
  command.add_option("-o,--output", s->folder, "Folder for the figures and the page, which take no other file's place")
      .required();
  command.add_option("--pictures", s->pictures, "Pictures of each session; 0: none, which needs no archives")
      .between(0, 100)
      .show_default();
  command.add_option("--data", s->data,
                     "Folder for the files that the logs bring along, and with those that are too large for them");
  command.tells_progress();
  command.examples({"palpate report monday.lcmlog friday.lcmlog -o out/report"});
  command.does([s] {
    catch_shutdown_signals();
    for (const std::string& sentence : report_logs(*s, [](const std::string& log) { cli::say(log); }))
      fmt::print(stderr, "palpate: {}\n", sentence);
  });
}

void add_path_command(cli::Command& app) {
  cli::Command command = app.add_command(
      "path", "Draw the way of a tool's tip over the organ at rest, with a ball at each place where it stands");
  auto s = std::make_shared<PathPictureSettings>();
  command.add_option("SCENE", s->scene, "Scene file (TOML)").required();
  command.add_option("TRAJECTORY", s->trajectory, "Motion of the tool (CSV), such as `palpate motion` makes")
      .required();
  command.add_option("-o,--output", s->picture, "Picture (PNG)").required().output_file(".png");
  command.add_option("--tool", s->tool, "Tool that moves (default: the only one)");
  command.examples({"palpate path scenes/liver.toml press.csv -o press.png"});
  command.does([s] {
    draw_path(*s);
    fmt::print("{}\n", s->picture);
  });
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  palpate::cli::CommandLine app{"Films and reports of topic logs, pictures of motions; started by `palpate`"};
  app.show_version(PALPATE_VERSION);
  app.require_command();
  app.examples({"palpate film out/liver.lcmlog -o out/liver.mp4", "palpate report out/liver.lcmlog -o out/page"});
  palpate::add_film_command(app);
  palpate::add_report_command(app);
  palpate::add_path_command(app);
  return app.run(argc, argv);
}

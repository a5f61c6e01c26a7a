#include "tools/film/log_film.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "common/realtime/shutdown.hpp"
#include "render_node/film.hpp"
#include "render_node/renderer.hpp"
#include "render_node/scene_stage.hpp"
#include "tools/film/log_pictures.hpp"
#include "tools/logs/log_files.hpp"

namespace palpate {
namespace {

/// Which part of the log is drawn [s], from the scene's first step on.
struct Stretch {
  double begin, end;
};

Stretch stretch_of(const LogFilmSettings& s, const LogContents& contents) {
  const double first = std::max(0.0, -contents.scene_begin), last = contents.seconds - contents.scene_begin;
  const Stretch stretch{std::max(s.from, first), s.to > 0 ? std::min(s.to, last) : last};
  if (!(stretch.begin < stretch.end))
    throw std::runtime_error(fmt::format("{}: there is nothing between {} s and {} s: the log has {:.2f} s to {:.2f} s",
                                         s.log, s.from, s.to > 0 ? s.to : last, first, last));
  return stretch;
}

}  // namespace

LogFilmReport film_log(const LogFilmSettings& s, const std::function<bool(long, long)>& progress) {
  const LoggedScene logged(s.log, s.data);
  logged.require_one_run();
  keep_files_of(logged.scene(), {s.film, s.still});
  const LogContents contents = contents_of(s.log, logged.scene());
  const Stretch stretch = stretch_of(s, contents);
  logged.ensure_archives();
  LogPictures pictures(s.log, contents, logged.scene());

  const Render picture = logged.scene().render.value_or(Render{});
  const int width = s.width > 0 ? s.width : picture.width, height = s.height > 0 ? s.height : picture.height;
  Renderer renderer(width, height, s.samples);
  Film film(s.film, width, height, s.rate);
  const long due = static_cast<long>(std::floor((stretch.end - stretch.begin) * s.rate / s.speed + 1e-6)) + 1;
  Image image;
  for (long i = 0; i < due; ++i) {
    if (!progress(i, due)) throw Interrupted(fmt::format("{}: stopped before its end", s.film));
    renderer.draw(pictures.at(stretch.begin + static_cast<double>(i) * s.speed / s.rate), image);
    film.add(image);
  }
  film.finish();
  if (!s.still.empty()) write_still(pictures.show().best_moment(), width, height, s.still);
  return {film.frames(), static_cast<double>(film.frames()) / s.rate, pictures.show().peak_force(),
          pictures.damage_text()};
}

}  // namespace palpate

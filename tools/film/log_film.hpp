#pragma once
#include <functional>
#include <string>

namespace palpate {

struct LogFilmSettings {
  std::string log, film;      ///< films are MP4
  std::string still;          ///< PNG of the moment of the greatest force; empty: none
  std::string data;           ///< folder for the files that the log brings along; empty: none
  double from = 0, to = 0;    ///< [s] from the scene's first step on; to 0: the log's end
  double speed = 1;           ///< 0.1: ten times slower than it was
  double rate = 30;           ///< [1/s] pictures of the film
  int width = 0, height = 0;  ///< [pixel] 0: the scene's
  int samples = 4;            ///< per pixel, 1 or 4
};

struct LogFilmReport {
  long frames = 0;
  double seconds = 0;     ///< of the film
  double peak_force = 0;  ///< [N]
  std::string damage;     ///< sentence on damaged places of the log, empty if none
};

/// Draws every picture that is due: what was known at its time, whatever the log's own pictures were, and the same
/// bytes each time. `progress` is told the pictures done and due; where it is false there is no film. Throws
/// std::runtime_error.
LogFilmReport film_log(const LogFilmSettings& settings, const std::function<bool(long, long)>& progress);

}  // namespace palpate

#pragma once
#include <memory>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/bus/clock_link.hpp"
#include "common/bus/link_watch.hpp"
#include "common/bus/presence.hpp"
#include "common/node/pace_watch.hpp"
#include "common/realtime/histogram.hpp"
#include "render_node/film.hpp"
#include "render_node/renderer.hpp"
#include "render_node/show.hpp"

namespace palpate {

/// Where a live film does not show a picture of its own for every frame.
struct FilmGaps {
  std::uint64_t repeated = 0;  ///< frames that show the picture of the frame before
  std::uint64_t skipped = 0;   ///< pictures that were due and left out, since the encoder was behind
  double longest_stand = 0;    ///< [s] for which one picture stands
};

/// What a run of the loop measured.
struct RenderReport {
  double seconds = 0;
  std::uint64_t frames = 0, missed = 0, refused = 0;
  std::uint64_t behind = 0;  ///< [s] in which pictures were left out
  double peak_force = 0;     ///< [N]
  Histogram latency;         ///< [ns] sense time of a step to the picture that first shows it
  Histogram draw;            ///< [ns] drawing and reading back
  FilmGaps film;
};

/// Takes the latest of everything at the visual rate and draws it.
class RenderLoop {
 public:
  RenderLoop(const Scene& scene, Stage stage, SurfaceSource& source, Bus& bus, Presence& presence, Renderer& renderer);

  /// The film takes its frames from now on, in real time: a picture that comes late stands for those it
  /// missed.
  void set_film(Film* film) { film_ = film; }

  /// The cuts of the scene's dynamic bodies; null, as at first, where there are none.
  void set_topology(TopologyFeed* topology) { show_.set_topology(topology); }

  /// Until `seconds` are over (0: no limit) or a stop is requested.
  const RenderReport& run(double seconds);

  /// What was to be seen at the greatest force, or now if there was none.
  const Stage& best_moment() const { return show_.best_moment(); }

 private:
  void step(std::int64_t begin);
  std::vector<std::string> state_lines() const;
  std::string range_warning() const;
  void add_to_film(std::int64_t since_begin);
  void tell_picture(std::int64_t done);
  void keep_house(std::int64_t now);

  double rate_wanted_hz_;
  Show show_;
  SurfaceSource& source_;
  Bus& bus_;
  Presence& presence_;
  Renderer& renderer_;
  ClockFollower clock_;
  LinkWatch link_;
  std::unique_ptr<Writer<PictureState>> pictures_;
  PictureState picture_;
  Film* film_ = nullptr;
  Image image_;
  Histogram recent_latency_;  ///< since the last status
  double rate_hz_ = 0;
  Percentiles shown_latency_;      ///< of the last second, for the overlay
  std::uint64_t shown_steps_ = 0;  ///< that it is of
  PaceWatch pace_{"the picture", "frames are left out"};
  std::uint64_t last_frames_ = 0, passes_ = 0;
  std::int64_t last_status_ns_ = 0;
  RenderReport report_;
};

}  // namespace palpate

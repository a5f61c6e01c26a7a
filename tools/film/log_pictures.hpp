#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "common/bus/bus.hpp"
#include "common/node/node_setup.hpp"
#include "common/node/surface_source.hpp"
#include "common/node/topology_feed.hpp"
#include "render_node/show.hpp"
#include "tools/film/log_contents.hpp"
#include "tools/film/log_stream.hpp"

namespace palpate {

/// What was to be seen in a log: shapes as it has them, or superposed from its contacts.
class LogPictures {
 public:
  /// The archives of the scene are there. Throws std::runtime_error if the log lacks what cannot be computed.
  LogPictures(const std::filesystem::path& log, const LogContents& contents, const Scene& scene);

  /// What was known `seconds` after the scene's first step; not before the time of the last call. The frame is good
  /// until the next one.
  Frame at(double seconds);
  const Show& show() const { return show_; }
  std::string damage_text() const { return stream_.damage_text(); }

 private:
  std::unique_ptr<SurfaceSource> make_source();

  double scene_begin_;  ///< [s] as of LogContents
  bool received_;       ///< all shapes are in the log
  LoadedScene loaded_;
  std::unique_ptr<Bus> bus_;
  Presence presence_;
  std::unique_ptr<SurfaceSource> source_;
  TopologyFeed topology_;
  Show show_;
  LogStream stream_;
};

}  // namespace palpate

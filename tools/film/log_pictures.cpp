#include "tools/film/log_pictures.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "common/bus/memory_bus.hpp"
#include "common/view/view_origin.hpp"
#include "render_node/scene_stage.hpp"

namespace palpate {
namespace {

/// Whether the log has the shapes of all bodies.
bool has_shapes(const LogContents& contents, const Scene& scene, const std::string& log) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (owner_of(scene.bodies[b]) == Owner::deform_node && !contents.shaped.contains(static_cast<std::uint32_t>(b)))
      throw std::runtime_error(
          fmt::format("{}: of body '{}', which moves by itself, it has no shape", log, name_of(scene.bodies[b])));
  return contents.shaped.size() == scene.bodies.size();
}

}  // namespace

LogPictures::LogPictures(const std::filesystem::path& log, const LogContents& contents, const Scene& scene)
    : scene_begin_(contents.scene_begin),
      received_(has_shapes(contents, scene, log.string())),
      loaded_(with_archives(scene, received_ ? ArchivePart::header : ArchivePart::surface, ArchivePart::header)),
      bus_(make_memory_bus(make_memory_network())),
      presence_(*bus_, "film", 0, loaded_.scene_hash, loaded_.archive_hash),
      source_(make_source()),
      topology_(*bus_, presence_, loaded_.archives),
      show_(loaded_.scene, make_stage(loaded_), *source_, *bus_, presence_),
      stream_(log, contents, loaded_, *bus_) {
  show_.set_topology(&topology_);
}

std::unique_ptr<SurfaceSource> LogPictures::make_source() {
  const Eigen::Vector3d origin = view_origin(loaded_.archives);
  if (!received_)
    return deform_surfaces(loaded_.scene, *bus_, presence_, Deformer(loaded_.scene, loaded_.archives), origin);
  std::vector<std::size_t> nodes;
  for (const Archive& archive : loaded_.archives) nodes.push_back(archive.surface.position.size());
  return receive_surfaces(*bus_, presence_, std::move(nodes), origin);
}

Frame LogPictures::at(double seconds) {
  stream_.send_until(scene_begin_ + seconds);
  presence_.watch();
  show_.take();
  std::string time = fmt::format("{:.2f} s", seconds);
  if (stream_.haptic_hz() > 0) time += fmt::format("   haptic {:.0f} Hz", stream_.haptic_hz());
  show_.tell({time});
  return show_.frame();
}

}  // namespace palpate

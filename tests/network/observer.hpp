#pragma once
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/dds_bus.hpp"
#include "common/bus/sequence.hpp"
#include "tests/network/two_hosts.hpp"

namespace palpate::testing {

/// Listens on host A, where the haptic node runs: its tool and force come without crossing the link, surfaces of a
/// deformation node on host B have crossed it.
class Observer {
 public:
  /// `keys`: a folder with those of the role observer, for nodes that have keys.
  explicit Observer(const TwoHosts& hosts, const std::filesystem::path& keys = {});

  /// Listens until `enough` says so, false if that is not within the limit.
  bool listen(std::chrono::milliseconds limit, const std::function<bool()>& enough);
  void listen(std::chrono::milliseconds time) {
    listen(time, [] { return false; });
  }

  /// A surface that came, or a picture that the render node on this host drew.
  struct Frame {
    std::uint64_t run, step;
    std::int64_t sense_ns, came_ns;
  };
  using Frames = std::vector<Frame>;
  /// A node of this role that announced itself last, empty if there is none.
  NodeStatus status(const std::string& role) const;

  ToolState tool;        ///< newest
  ForceState force;      ///< newest
  SurfaceState surface;  ///< newest
  Frames surfaces, pictures;
  std::vector<TopologyChange> changes;
  SequenceCheck forces;   ///< every force sample
  bool finite = true;     ///< all forces so far
  double min_energy = 0;  ///< [J]
  double max_jump = 0;    ///< [N] between forces of successive steps of one run; set it back as needed

 private:
  void take();
  void take(const ForceState& next);

  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Reader<ToolState>> tools_;
  std::unique_ptr<Reader<ForceState>> forces_;
  std::unique_ptr<Reader<SurfaceState>> surface_reader_;
  std::unique_ptr<Reader<PictureState>> picture_reader_;
  std::unique_ptr<Reader<TopologyChange>> changes_;
  std::unique_ptr<Reader<NodeStatus>> statuses_;
  std::map<std::string, NodeStatus> known_;
};

/// Ages [s] at their arrival of the frames that came since a moment, sorted.
std::vector<double> ages(const Observer::Frames& frames, std::int64_t since_ns);
/// When the first frame came that shows what was sensed after a moment; 0 if none has.
std::int64_t first_since(const Observer::Frames& frames, std::int64_t sense_ns);
/// No frame shows an earlier step than one before it of the same run.
bool never_go_back(const Observer::Frames& frames);
/// The value below which a share of sorted values lies; 0 if there are none.
double at_share(const std::vector<double>& sorted, double share);

}  // namespace palpate::testing

#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// What goes between this node and a page, as plain values and bytes; docs/live.md has the layout. All numbers are
/// little-endian. Lengths in metres, world frame.
namespace palpate::web {

/// First word of a binary message to the page.
enum class Kind : std::uint32_t { scenery = 1, topology = 2, frame = 3 };

/// What a message to the page is about. A page that is slow gets the newest of each, in this order.
enum Slot : std::uint8_t { hello, scenery, topology, status, frame, kSlots };

struct Message {
  bool text = false;  ///< JSON
  std::string bytes;
};

/// JSON with arrays beside it: kind, length of the JSON, the JSON padded to 4 bytes, then the arrays. In the JSON an
/// array is {"at": byte behind the JSON, "count": numbers, "type": "f32", "u32", "i32" or "u8"}.
class Container {
 public:
  nlohmann::json add(std::span<const Eigen::Vector3f> vectors);
  nlohmann::json add(std::span<const std::array<int, 3>> triangles);
  nlohmann::json add_numbers(std::span<const float> numbers);
  nlohmann::json add_integers(std::span<const int> integers);
  nlohmann::json add_bytes(std::string_view bytes);
  /// Throws std::runtime_error where it would not fit 32 bits.
  std::string finish(Kind kind, const nlohmann::json& json) const;

 private:
  nlohmann::json append(const void* data, std::size_t bytes, std::size_t count, const char* type);

  std::string arrays_;
};

/// One instrument in a frame.
struct FrameTool {
  std::array<Eigen::Isometry3f, 3> parts;           ///< shaft, upper jaw, lower jaw: from the tip frame to the world
  Eigen::Vector3f force = Eigen::Vector3f::Zero();  ///< [N] on the tool at its tip
  float grip_torque = 0;                            ///< [N m] on the handle, opens the jaws
  std::uint32_t flags = 0;                          ///< ForceFlag bits, and those below
  std::uint32_t sample = 0;                         ///< newest number of the holder that moves the tool; 0: none yet
  std::uint32_t holder = 0, asker = 0;              ///< pages by their number; 0: none
  float roll = 0, grip = 0;                         ///< [rad] of the tool, of its handle
  float pedal = 0;
};
inline constexpr std::uint32_t kSeen = 1u << 31;     ///< FrameTool::flags: its pose is known
inline constexpr std::uint32_t kOffered = 1u << 30;  ///< a person may take it
inline constexpr std::uint32_t kHolding = 1u << 29;  ///< its jaws are shut on what is between them
inline constexpr std::uint32_t kUnheard = 1u
                                          << 28;  ///< nothing comes of it: where it is now, and its force, nobody knows

/// The state of a moment.
struct Frame {
  std::uint32_t topology = 0;  ///< number of the one that the bodies' nodes belong to
  std::uint32_t number = 0;
  double sense_s = 0;    ///< [s] when the device was read, since this node began; what the curves run over
  float latency_ms = 0;  ///< [ms] from there until this frame was made
  std::span<const FrameTool> tools;
  std::vector<std::span<const Eigen::Vector3f>> bodies;  ///< [m] per surface node
};

/// Positions as 16-bit steps of each axis' own extent: wrong by half a step at most, extent / 131070.
std::string encode(const Frame& frame);

/// What a page says.
struct Sample {
  std::uint32_t number = 0;   ///< from 1, since the page came
  Eigen::Vector3d tip;        ///< [m] where the tip shall go
  double roll = 0, grip = 0;  ///< [rad]
  double pedal = 0;           ///< from 0 to 1
  bool again = false;         ///< the server's word for a page that is silent: see StandingHand
};
struct Said {
  enum Kind : std::uint8_t { sample = 1, take, release, give, taken, rest } kind;
  std::uint8_t tool = 0;
  Sample motion;             ///< of a sample
  std::uint32_t number = 0;  ///< frames that have been taken
};
inline constexpr std::size_t kMaxBytesSaid = 32;

/// Empty for what is no such message: wrong length or kind, bits that are reserved, or a number that is none.
std::optional<Said> decode(std::string_view bytes);

}  // namespace palpate::web

#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "tests/bus/domain.hpp"
#include "tests/tools/program_result.hpp"

namespace palpate::testing {

/// The files that a whole session of `palpate run` leaves.
struct Session {
  explicit Session(const std::filesystem::path& folder)
      : film(folder / "session.mp4"),
        still(folder / "session.png"),
        log(folder / "session.lcmlog"),
        summary(folder / "session.json") {}
  std::vector<std::string> arguments(const LoopbackScene& scene, int processes) const {
    return {program("palpate"),
            "run",
            scene.scene(),
            "--processes",
            std::to_string(processes),
            "--domain",
            std::to_string(own_domain()),
            "--film",
            film,
            "--still",
            still,
            "--record",
            log,
            "--summary",
            summary};
  }
  std::filesystem::path film, still, log, summary;
};

/// As one line of a shell.
inline std::string joined(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += word + " ";
  return line;
}

/// A tool that presses the tissue 5 mm deep, slides and lets go, all at 5 mm/s: a host that stands for a third of a
/// second does not make a jump of it.
inline constexpr const char* kSlowPress =
    "time,yaw,pitch,depth,roll,grip\n0,0,0,0.191,0,0\n1.2,0,0,0.197,0,0\n2.4,0.03,0,0.197,0.1,0\n3.6,0.03,0,0.191,0.1,"
    "0\n";

/// A tool that stands above the tissue for a minute.
inline constexpr const char* kLongRest = "time,yaw,pitch,depth,roll,grip\n0,0,0,0.17,0,0\n60,0,0,0.17,0,0\n";

}  // namespace palpate::testing

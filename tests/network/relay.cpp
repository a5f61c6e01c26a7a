// Carries packets between two TUN devices, badly if asked to.
//   relay A B SEED    A, B: open descriptors of the devices
// Lines on standard input change it while it runs: "ab delay 0.1 loss 0.3", "ba cut 1", "both clear". It ends with its
// standard input.
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <string>

#include "common/realtime/clock.hpp"
#include "common/realtime/settings.hpp"
#include "tests/network/lane.hpp"

namespace palpate::testing {
namespace {

struct Way {
  int from, to;
  Lane lane;

  void take_in() {
    std::array<std::uint8_t, 65536> buffer;
    for (ssize_t n; (n = read(from, buffer.data(), buffer.size())) > 0;)
      lane.put({buffer.data(), static_cast<std::size_t>(n)}, now_ns());
  }
  void give_out() {
    while (const auto packet = lane.take(now_ns()))
      if (write(to, packet->data(), packet->size()) < 0) continue;  // the device is full or down: lost, as on any line
  }
};

bool obey(const std::string& line, std::array<Way, 2>& ways) {
  std::istringstream words(line);
  std::string where;
  words >> where;
  if (where != "ab" && where != "ba" && where != "both") return false;
  const auto rest = words.tellg();
  for (int w = where == "ba"; w <= (where != "ab"); ++w) {
    Impairment impairment = ways[w].lane.impairment();
    words.clear();
    words.seekg(rest);
    if (!change(impairment, words)) return false;
    ways[w].lane.set(impairment);
  }
  return true;
}

/// Takes what has come on standard input; false at its end.
bool take_lines(std::string& partial, std::array<Way, 2>& ways) {
  std::array<char, 1024> buffer;
  const ssize_t n = read(STDIN_FILENO, buffer.data(), buffer.size());
  if (n <= 0) return false;
  partial.append(buffer.data(), static_cast<std::size_t>(n));
  for (std::size_t end; (end = partial.find('\n')) != std::string::npos; partial.erase(0, end + 1))
    if (!obey(partial.substr(0, end), ways))
      fmt::print(stderr, "relay: '{}' is not understood\n", partial.substr(0, end));
  return true;
}

void carry(std::array<Way, 2>& ways) {
  std::string partial;
  for (;;) {
    const std::int64_t due = std::min(ways[0].lane.next_due(), ways[1].lane.next_due());
    const std::int64_t rest = std::clamp<std::int64_t>(due == Lane::kNever ? kNsPerS : due - now_ns(), 0, kNsPerS);
    const timespec timeout{rest / kNsPerS, rest % kNsPerS};
    std::array<pollfd, 3> ready{{{ways[0].from, POLLIN, 0}, {ways[1].from, POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}}};
    ppoll(ready.data(), ready.size(), &timeout, nullptr);
    if (ready[2].revents != 0 && !take_lines(partial, ways)) return;
    for (int w = 0; w < 2; ++w) {
      if (ready[w].revents & POLLIN)
        ways[w].take_in();
      else if (ready[w].revents != 0)
        sleep_until_ns(now_ns() + kNsPerS / 100);  // the device is down or gone
      ways[w].give_out();
    }
  }
}

}  // namespace
}  // namespace palpate::testing

int main(int argc, char** argv) {
  using palpate::testing::Lane;
  if (argc != 4) {
    fmt::print(stderr, "relay: wants two descriptors and a seed\n");
    return 1;
  }
  const int a = std::stoi(argv[1]), b = std::stoi(argv[2]);
  const std::uint64_t seed = std::stoull(argv[3]);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  palpate::request_realtime({.priority = 90, .lock_memory = false});  // a network does not wait for the machine's load
  std::array<palpate::testing::Way, 2> ways{{{a, b, Lane(2 * seed)}, {b, a, Lane(2 * seed + 1)}}};
  palpate::testing::carry(ways);
}

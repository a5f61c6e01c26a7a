#include "tests/network/two_hosts.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "tests/loopback/loopback_scene.hpp"

namespace palpate::testing {
namespace {

/// A TUN device in a namespace; it lives as long as the descriptor, which programs that are started inherit.
int open_tun(const NetworkNamespace& space) {
  const Inside here(space);
  const int descriptor = open("/dev/net/tun", O_RDWR | O_NONBLOCK);
  ifreq request{};
  std::strncpy(request.ifr_name, TwoHosts::device, IFNAMSIZ - 1);
  request.ifr_flags = IFF_TUN | IFF_NO_PI;
  if (descriptor < 0 || ioctl(descriptor, TUNSETIFF, &request) != 0)
    throw std::runtime_error(fmt::format("this process may not make TUN devices: {}", std::strerror(errno)));
  return descriptor;
}

void set_up(const NetworkNamespace& space, const char* address) {
  space.ip(fmt::format("address add {}/24 dev {}", address, TwoHosts::device));
  space.ip(fmt::format("link set {} up", TwoHosts::device));
}

}  // namespace

TwoHosts::TwoHosts(Link link, int seed) {
  if (link == Link::veth)
    join_by_veth();
  else
    join_by_relay(seed);
  set_up(a_, address_a);
  set_up(b_, address_b);
}

TwoHosts::~TwoHosts() {
  if (relay_) pclose(relay_);
}

void TwoHosts::join_by_veth() {
  a_.ip(fmt::format("link add {0} type veth peer name {0} netns {1}", device, b_.path()));
}

void TwoHosts::join_by_relay(int seed) {
  const int a = open_tun(a_), b = open_tun(b_);
  const Inside here(a_);  // so that whoever looks for what is left in the namespaces finds it
  relay_ = popen(fmt::format("exec {} {} {} {}", program("relay"), a, b, seed).c_str(), "we");
  close(a);
  close(b);
  if (!relay_) throw std::runtime_error("cannot start the relay");
}

void TwoHosts::impair(const std::string& line) const {
  fmt::print(relay_, "{}\n", line);
  std::fflush(relay_);
}

}  // namespace palpate::testing

#include <arpa/inet.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ifaddrs.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "common/bus/dds_bus.hpp"

namespace palpate {
namespace {

/// Names go into XML text: letters, digits and what hosts and interfaces are written with.
void check_name(const std::string& what, const std::string& name) {
  const auto allowed = [](unsigned char c) {
    return std::isalnum(c) || std::string_view(".:_-%[]").find(c) != std::string_view::npos;
  };
  if (name.empty() || !std::all_of(name.begin(), name.end(), allowed))
    throw std::runtime_error(fmt::format("network: '{}' is not a name or address of {}", name, what));
}

bool is_address(const std::string& text) {
  in_addr v4;
  in6_addr v6;
  return inet_pton(AF_INET, text.c_str(), &v4) == 1 || inet_pton(AF_INET6, text.c_str(), &v6) == 1;
}

/// IPv4 address of an interface of this host, given by name or by address; empty if it has none.
std::string address_of(const std::string& interface) {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return {};
  std::string found;
  for (const ifaddrs* entry = list; entry && found.empty(); entry = entry->ifa_next) {
    if (!entry->ifa_addr || entry->ifa_addr->sa_family != AF_INET) continue;
    char text[INET_ADDRSTRLEN] = "";
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(entry->ifa_addr)->sin_addr, text, sizeof text);
    if (interface == entry->ifa_name || interface == text) found = text;
  }
  freeifaddrs(list);
  return found;
}

/// What differs between loopback and a real network.
struct Parts {
  std::string general;
  std::string peers;
  std::string internal{};
};

std::string peer_list(const std::vector<std::string>& peers) {
  std::string xml = "<Peers>";
  for (const std::string& peer : peers) xml += fmt::format("<Peer address=\"{}\"/>", peer);
  return xml + "</Peers>";
}

/// Loopback needs its own address as a peer: discovery without multicast goes through peers alone.
Parts loopback_network(const BusSettings& settings) {
  std::vector<std::string> peers{"127.0.0.1"};
  peers.insert(peers.end(), settings.peers.begin(), settings.peers.end());
  return {
      "<General><Interfaces><NetworkInterface address=\"127.0.0.1\" multicast=\"false\"/></Interfaces>"
      "<AllowMulticast>false</AllowMulticast></General>",
      peer_list(peers)};
}

/// With a receiving thread per socket the middleware ends by sending to itself, and a node would never end once its
/// interface is gone: one thread receives for all.
Parts real_network(const BusSettings& settings) {
  const std::string own = address_of(settings.interface);
  if (own.empty() && !is_address(settings.interface))
    throw std::runtime_error(
        fmt::format("network: this host has no interface '{}' with an IPv4 address", settings.interface));
  if (own.empty())
    throw std::runtime_error(fmt::format("network: no interface of this host has the address {}", settings.interface));
  std::vector<std::string> peers = settings.peers;
  if (!peers.empty()) peers.push_back(own);
  return {fmt::format("<General><Interfaces><NetworkInterface "
                      "address=\"{}\"/></Interfaces><AllowMulticast>{}</AllowMulticast>"
                      "<MaxMessageSize>1400B</MaxMessageSize><FragmentSize>1300B</FragmentSize></General>",
                      own, settings.peers.empty() ? "true" : "false"),
          peer_list(peers), "<MultipleReceiveThreads>false</MultipleReceiveThreads>"};
}

}  // namespace

std::string dds_place(const BusSettings& settings) {
  const bool loopback = settings.interface.empty();
  const std::string interface =
      loopback ? "this host alone" : fmt::format("{} ({})", settings.interface, address_of(settings.interface));
  const std::string asked = settings.peers.empty() ? (loopback ? "" : ", asking by multicast")
                                                   : fmt::format(", asking {}", fmt::join(settings.peers, ", "));
  const std::string keys = settings.keys.empty() ? "" : fmt::format(", with the keys in {}", settings.keys.string());
  return fmt::format("domain {} on {}, UDP ports from {}{}{}", settings.domain, interface, 7400 + 250 * settings.domain,
                     asked, keys);
}

std::string dds_configuration(const BusSettings& settings) {
  if (settings.domain < 0 || settings.domain > 230)
    throw std::runtime_error(fmt::format("network: domain {} is outside 0..230", settings.domain));
  if (!settings.interface.empty()) check_name("an interface", settings.interface);
  for (const std::string& peer : settings.peers) check_name("a peer", peer);

  const Parts parts = settings.interface.empty() ? loopback_network(settings) : real_network(settings);
  // A participant that falls silent is kept for two minutes so that a cut cable costs neither history nor the time to
  // find each other again; after a longer cut that takes up to two seconds. Its death is known earlier by the
  // liveliness lease. Frequent heartbeats repair a lost datagram within milliseconds. The high
  // watermark lies above what any keep-last writer holds, so that such a writer is never throttled. A reader of a
  // stream forgets samples that lack a fragment once a newer one is complete; after as many of them in a row as it may
  // put together at once it would take nothing more, so that this number is large. A reader that stood still for a
  // tenth of a second at full rate lacks megabytes: it asks for a socket that holds them, keeps what comes after a gap,
  // and the writer repeats it all at the first asking. Fragments are asked for one sample at a time, so that it asks
  // often. Who wants the newest alone has a smaller one: where it does not keep up, what comes is lost there, and not
  // seconds late.
  return fmt::format(
      "<CycloneDDS><Domain Id=\"{}\">{}"
      "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>60</"
      "MaxAutoParticipantIndex>"
      "<LeaseDuration>120 s</LeaseDuration><SPDPInterval>2 s</SPDPInterval>{}</Discovery>"
      "<Internal>{}<HeartbeatInterval min=\"2 ms\" minsched=\"2 ms\" max=\"50 ms\">5 ms</HeartbeatInterval>"
      "<NackDelay>10 ms</NackDelay><SocketReceiveBufferSize max=\"{} "
      "MB\"/><PrimaryReorderMaxSamples>4096</PrimaryReorderMaxSamples>"
      "<MaxQueuedRexmitBytes>8 MB</MaxQueuedRexmitBytes><MaxQueuedRexmitMessages>4096</MaxQueuedRexmitMessages>"
      "<MaxSampleSize>64 MB</MaxSampleSize><DefragReliableMaxSamples>2048</DefragReliableMaxSamples>"
      "<Watermarks><WhcLow>1 MB</WhcLow><WhcHigh>128 MB</WhcHigh><WhcHighInit>128 MB</WhcHighInit>"
      "<WhcAdaptive>false</WhcAdaptive></Watermarks><WriteBatch>{}</WriteBatch></Internal>"
      "</Domain></CycloneDDS>",
      settings.domain, parts.general, parts.peers, parts.internal, settings.newest_alone ? 2 : 8, settings.gathers);
}

}  // namespace palpate

#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/describe/description.hpp"

namespace palpate {

/// Only who has keys of one authority takes part, and what crosses the network is encrypted.
struct Security {
  std::filesystem::path keys;  ///< folder that `palpate keys` made, or that of one role in it
};

inline void describe(Description& d, Security& s) {
  d.path({"keys", "", "folder that `palpate keys` made, or that of one role in it; see [security.md](security.md)",
          Need::required, Use::local},
         s.keys);
}

struct Network {
  int domain = 0;
  std::string interface;  ///< empty: loopback
  std::vector<std::string> peers;
  std::optional<Security> security;  ///< absent: open to all, and nothing of it is loaded
};

inline void describe(Description& d, Network& n) {
  d.integer({"domain", "", "DDS domain", Need::optional, Use::local}, n.domain, 0, 230);
  d.text({"interface", "", "network interface", Need::optional, Use::local, "loopback"}, n.interface);
  d.texts({"peers", "", "addresses to find without multicast", Need::optional, Use::local}, n.peers);
  d.table({"security", "", "who may take part", Need::optional, Use::local, "open to all"}, n.security);
}

struct Record {
  std::filesystem::path file;
};

inline void describe(Description& d, Record& r) {
  d.path({"file", "", "LCM event log to write", Need::required, Use::local}, r.file);
}

}  // namespace palpate

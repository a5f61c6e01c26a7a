#pragma once
#include <string>

#include "common/describe/description.hpp"

namespace palpate {

/// Where browsers find the live view; nothing is started by it alone.
struct Web {
  std::string address = "127.0.0.1";
  int port = 8080;
};

inline void describe(Description& d, Web& w) {
  d.text({"address", "", "to listen at; one that other hosts can reach makes a page with a secret in its address",
          Need::optional, Use::local},
         w.address);
  d.integer({"port", "", "of the page; 0: any that is free", Need::optional, Use::local}, w.port, 0, 65535);
}

}  // namespace palpate

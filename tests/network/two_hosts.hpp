#pragma once
#include <cstdio>
#include <string>

#include "tests/network/namespaces.hpp"

namespace palpate::testing {

/// Two network namespaces that stand for two machines, joined by one link. In both the device is called `device`.
class TwoHosts {
 public:
  enum class Link {
    veth,  ///< a cable, as good as the kernel's
    relay  ///< two TUN devices with the relay program between them
  };
  static constexpr const char *device = "link0", *address_a = "10.77.0.1", *address_b = "10.77.0.2";

  /// Throws std::runtime_error with the reason where this is not permitted.
  explicit TwoHosts(Link link, int seed = 1);
  ~TwoHosts();
  TwoHosts(const TwoHosts&) = delete;
  TwoHosts& operator=(const TwoHosts&) = delete;

  const NetworkNamespace& a() const { return a_; }
  const NetworkNamespace& b() const { return b_; }
  /// Changes what the relay does, as in "both delay 0.1 loss 0.3"; see relay.cpp.
  void impair(const std::string& line) const;

 private:
  void join_by_veth();
  void join_by_relay(int seed);

  NetworkNamespace a_, b_;
  std::FILE* relay_ = nullptr;
};

}  // namespace palpate::testing

#pragma once
#include <string>
#include <vector>

#include "tests/loopback/loopback_scene.hpp"
#include "tests/network/two_hosts.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate::testing {

/// The block of the loopback tests under a tool that presses for three minutes and slides about meanwhile.
class NetworkScene : public LoopbackScene {
 public:
  explicit NetworkScene(const std::string& name, double young = 5000);
};

/// The block as moving tissue, cut across within three seconds after a second.
class CutScene : public LoopbackScene {
 public:
  explicit CutScene(const std::string& name);
};

/// The same, cut to and fro for forty seconds: by then a node has come that was late or died.
class LongCutScene : public CutScene {
 public:
  explicit LongCutScene(const std::string& name);
};

/// Computes a scene's tensors.
void precompute(const LoopbackScene& scene);

/// Starts the programs of one simulation on two hosts. What each says on standard error is kept.
class Nodes {
 public:
  static constexpr int kDomain = 3;

  Nodes(const TwoHosts& hosts, const LoopbackScene& scene) : hosts_(hosts), scene_(scene) {}

  /// `name`: haptic_node, deform_node or render_node.
  ChildProcess on_a(const std::string& name, const std::vector<std::string>& more = {}) const {
    return start(hosts_.a(), TwoHosts::address_b, name, more);
  }
  ChildProcess on_b(const std::string& name, const std::vector<std::string>& more = {}) const {
    return start(hosts_.b(), TwoHosts::address_a, name, more);
  }
  /// `palpate record` to a file in the scene's folder.
  ChildProcess recorder_on_b(const std::string& file) const;
  /// All that programs of this name have said.
  std::string said(const std::string& name) const;

 private:
  ChildProcess start(const NetworkNamespace& host, const char* peer, const std::string& name,
                     const std::vector<std::string>& more) const;
  ChildProcess launch(const NetworkNamespace& host, const char* peer, const std::string& name,
                      const std::string& command) const;

  const TwoHosts& hosts_;
  const LoopbackScene& scene_;
};

}  // namespace palpate::testing

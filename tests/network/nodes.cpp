#include "tests/network/nodes.hpp"

#include <cmath>
#include <stdexcept>

namespace palpate::testing {

NetworkScene::NetworkScene(const std::string& name, double young) : LoopbackScene("network-" + name, kLinear, young) {
  std::string motion = "time,yaw,pitch,depth,roll,grip\n0,0,0,0.17,0,0\n0.5,0,0,0.197,0,0\n";
  for (int i = 1; i <= 4000; ++i) {
    const double phase = 0.05 * i * 2 * 3.14159265358979;
    motion += fmt::format("{:.2f},{:.6f},{:.6f},{:.6f},0,0\n", 0.5 + 0.05 * i, 0.05 * std::sin(0.5 * phase),
                          0.03 * std::sin(0.3 * phase), 0.197 + 0.001 * std::sin(phase));
  }
  write("motion.csv", motion);
  replace("width = 320\nheight = 240", "width = 160\nheight = 120");
}

CutScene::CutScene(const std::string& name) : LoopbackScene("network-" + name, "[body.dynamic]\ndamping = 20\n") {
  replace("quasi_static", "tensor_mass");
  replace("radius = 0.008", "radius = 0.008\ncautery = { radius = 0.009 }");
  replace("width = 320\nheight = 240", "width = 160\nheight = 120");
  write("motion.csv",
        "time,yaw,pitch,depth,roll,grip,pedal\n0,0.3,0,0.17,0,0,0\n0.7,0.3,0,0.17,0,0,0\n1.0,0.3,0,0.21,0,0,1\n3.0,-0."
        "3,0,0.21,0,0,1\n"
        "3.3,-0.3,0,0.17,0,0,0\n60,0,0,0.17,0,0,0\n");
}

LongCutScene::LongCutScene(const std::string& name) : CutScene(name) {
  std::string motion = "time,yaw,pitch,depth,roll,grip,pedal\n0,0.3,0,0.17,0,0,0\n0.7,0.3,0,0.17,0,0,0\n";
  for (int pass = 0; pass <= 20; ++pass)
    motion += fmt::format("{},{},0,0.21,0,0,1\n", 1 + 2 * pass, pass % 2 == 0 ? 0.3 : -0.3);
  write("motion.csv", motion + "41.3,0.3,0,0.17,0,0,0\n300,0.3,0,0.17,0,0,0\n");
}

void precompute(const LoopbackScene& scene) {
  std::string said;
  if (run_command(program("palpate") + " precompute " + scene.scene(), &said) != 0) throw std::runtime_error(said);
}

ChildProcess Nodes::start(const NetworkNamespace& host, const char* peer, const std::string& name,
                          const std::vector<std::string>& more) const {
  std::string command = fmt::format("{} {}", program(name), scene_.scene());
  for (const std::string& word : more) command += " " + word;
  return launch(host, peer, name, command);
}

ChildProcess Nodes::recorder_on_b(const std::string& file) const {
  return launch(
      hosts_.b(), TwoHosts::address_a, "palpate",
      fmt::format("{} record --keep everything -o {}", program("palpate"), (scene_.folder() / file).string()));
}

ChildProcess Nodes::launch(const NetworkNamespace& host, const char* peer, const std::string& name,
                           const std::string& command) const {
  const Inside here(host);
  const std::string network = fmt::format("--domain {} --interface {} --peer {}", kDomain, TwoHosts::device, peer);
  return ChildProcess(
      name, {"/bin/sh", "-c",
             fmt::format("exec {} {} 2>>{}", command, network, (scene_.folder() / (name + ".said")).string())});
}

std::string Nodes::said(const std::string& name) const {
  std::ifstream in(scene_.folder() / (name + ".said"));
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace palpate::testing

#include "tests/hostile/attacked_system.hpp"

#include <fstream>

#include "common/bus/security.hpp"
#include "common/realtime/clock.hpp"
#include "tools/keys/documents.hpp"
#include "tools/keys/key_folder.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

constexpr double kHover = 0.186;  // [m] of depth: the tip's ball ends 6 mm above the tissue
constexpr double kElsewhere = 0.1;

double resident_mb(pid_t pid) {
  std::ifstream in(fmt::format("/proc/{}/statm", pid));
  double total = 0, resident = 0;
  in >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Keys of every role, and those of the insider.
void make_keys(const std::filesystem::path& folder) {
  constexpr std::time_t day = 24 * 60 * 60;
  const keys::Period period{std::time(nullptr) - day, std::time(nullptr) + 30 * day};
  keys::make_folder(folder, period);
  keys::add_keys(folder, "player", "insider", period);
  const keys::Identity authority{text_of(folder / "authority/key.pem"), text_of(folder / "authority/certificate.pem")};
  const KeyFiles files = key_files(folder / "insider");
  const Rights all{rights_of("player").writes, rights_of("observer").reads};
  const std::string subject = keys::subject_of(text_of(files.certificate));
  std::ofstream(files.permissions) << keys::sign(authority, keys::permissions_document("player", subject, all, period));
}

}  // namespace

HostileScene::HostileScene(bool with_keys)
    : LoopbackScene("hostile", "[body.dynamic]\ndamping = 20\n"), with_keys_(with_keys) {
  if (with_keys) {
    replace("[render]\n", "[network.security]\nkeys = \"keys\"\n\n[render]\n");
    make_keys(folder() / "keys");
  }
  replace("quasi_static", "tensor_mass");
  replace("width = 320\nheight = 240", "width = 64\nheight = 64");
  replace("[[tool]]", R"([rates]
visual_hz = 30

[[body]]
name = "still"
mesh = "block.msh"
model = "quasi_static"
young = 5000
poisson = 0.4
[body.offline]
element = "p1"
[[body.fixed]]
box = [[-1.0, -1.0, -0.0501], [1.0, 1.0, -0.0499]]

[web]
port = 0

[[tool]]
name = "elsewhere"
pivot = [0.5, 0.0, 0.4]
radius = 0.008
device = "bus"

[[tool]])");
  write("motion.csv", fmt::format("time,yaw,pitch,depth,roll,grip\n0,0,0,{0},0,0\n3600,0,0,{0},0,0\n", kHover));
}

BusSettings HostileScene::insider(int domain) const {
  if (!with_keys_) return {.domain = domain};
  return {.domain = domain, .keys = folder() / "keys/insider", .role = "player"};
}

AttackedSystem::AttackedSystem(int domain, bool with_keys)
    : scene_(with_keys),
      attacker_(scene_.insider(domain)),
      hand_(scene_.insider(domain), 1),
      status_(attacker_.bus().reader(topics::node_status)),
      picture_(attacker_.bus().reader(topics::picture_state)) {
  std::string said;
  if (run_command(program("palpate") + " precompute " + scene_.scene(), &said) != 0) throw std::runtime_error(said);
  driver_ = std::thread([this] { drive(); });
  for (const char* name : {"deform", "render", "web", "haptic"})
    nodes_.emplace(name, ChildProcess(name, {program(std::string(name) + "_node"), scene_.scene(), "--domain",
                                             std::to_string(domain), "--supervised"}));
  const bool there = watch(30s, [&] { return hand_.newest().step > 800 && statuses_.size() == 4 && pictures_ > 20; });
  if (!there) throw std::runtime_error("the attacked system does not come up");
}

AttackedSystem::~AttackedSystem() {
  over_ = true;
  driver_.join();
}

// A driver as it should be: a hand that rests.
void AttackedSystem::drive() {
  const auto device = attacker_.bus().writer(topics::device_state);
  for (DeviceState state{.tool = 0, .seq = 1, .depth = kElsewhere}; !over_; ++state.seq) {
    state.sense_ns = now_ns();
    device->write(state);
    std::this_thread::sleep_for(5ms);
  }
}

void AttackedSystem::look() {
  hand_.look();
  while (const auto status = status_->take())
    for (const auto& [name, process] : nodes_)
      if (status->node.starts_with(fmt::format("{} {}@", name, process.pid()))) {
        statuses_[name] = *status;
        said_[name] += status->text + '\n';
      }
  while (const auto picture = picture_->take()) newest_picture_ = *picture, ++pictures_;
}

bool AttackedSystem::all_run() {
  return std::ranges::all_of(nodes_, [](auto& node) { return node.second.running(); });
}

std::map<std::string, double> AttackedSystem::memory_mb() const {
  std::map<std::string, double> memory;
  for (const auto& [name, process] : nodes_) memory[name] = resident_mb(process.pid());
  return memory;
}

bool AttackedSystem::pictures_go_on(std::chrono::milliseconds limit) {
  const std::uint64_t step = hand_.newest().step, run = hand_.newest().run;
  return watch(limit, [&] {
    return newest_picture_.run == run && newest_picture_.step > step && newest_picture_.step <= hand_.newest().step;
  });
}

std::map<std::string, nlohmann::json> AttackedSystem::end() {
  std::map<std::string, nlohmann::json> said;
  for (auto& [name, process] : nodes_) process.interrupt();
  for (auto& [name, process] : nodes_) {
    if (!process.wait(10s) || process.status() != 0) continue;
    for (const std::string& line : process.take_lines())
      if (line.starts_with("{")) said[name] = nlohmann::json::parse(line);
  }
  return said;
}

}  // namespace palpate::testing

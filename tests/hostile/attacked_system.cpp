#include "tests/hostile/attacked_system.hpp"

#include <algorithm>
#include <fstream>

#include "common/bus/security.hpp"
#include "common/realtime/clock.hpp"
#include "tests/realtime/resident.hpp"
#include "tests/sanitized.hpp"
#include "tools/keys/documents.hpp"
#include "tools/keys/key_folder.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

constexpr double kHover = 0.186;  // [m] of depth: the tip's ball ends 6 mm above the tissue
// [s] over the tissue, where the case in free air ends after 8, on a busy machine 13, with keys 19 while two compilers
// ran; and then until it presses
constexpr double kWaits = kSanitized ? 20 : 15, kWaitsWithKeys = 35, kComesDown = 2;
constexpr double kYoung = 20e3;               // [Pa] of both blocks
constexpr double kFelt = 1;                   // [N] where a tool presses
constexpr double kSettled = 0.01;             // [N] by which a force that is at rest may be off
constexpr std::uintmax_t kHears = 1'000'000;  // [bytes] of a log whose recorder has met all
constexpr std::uint64_t kSoon = 60'000;  // [steps] that a picture told of in time may be ahead of what is known here

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
    : LoopbackScene("hostile", "[body.dynamic]\ndamping = 20\n", kYoung), with_keys_(with_keys) {
  if (with_keys) {
    replace("[render]\n", "[network.security]\nkeys = \"keys\"\n\n[render]\n");
    make_keys(folder() / "keys");
  }
  replace("quasi_static", "tensor_mass");
  replace("width = 320\nheight = 240", "width = 64\nheight = 64");
  write_tet_mesh(make_block({0.15, -0.05, -0.05}, {0.25, 0.05, 0}, {8, 8, 4}), folder() / "still.msh");
  replace("[[tool]]", fmt::format(R"([rates]
visual_hz = 30

[[body]]
name = "still"
mesh = "still.msh"
model = "quasi_static"
young = {}
poisson = 0.4
[body.offline]
element = "p1"
[[body.fixed]]
box = [[-1.0, -1.0, -0.0501], [1.0, 1.0, -0.0499]]

[web]
port = 0

[[tool]]
name = "driven"
pivot = [0.2, 0.0, 0.2]
radius = 0.008
device = "bus"

[[tool]])",
                                  kYoung));
  replace("[render]\n", R"([[tool]]
name = "hovering"
pivot = [0.03, 0.03, 0.2]
radius = 0.008
device = "scripted"
trajectory = "hover.csv"

[render]
)");
  const std::string begin = fmt::format("time,yaw,pitch,depth,roll,grip\n0,0,0,{},0,0\n", kHover);
  write("motion.csv", begin + fmt::format("{2},0,0,{0},0,0\n{3},0,0,{1},0,0\n9000,0,0,{1},0,0\n", kHover, kPressed,
                                          waits(), waits() + kComesDown));
  write("hover.csv", begin + fmt::format("9000,0,0,{},0,0\n", kHover));
}

double HostileScene::waits() const {
  return with_keys_ ? kWaitsWithKeys : kWaits;
}

BusSettings HostileScene::insider(int domain) const {
  if (!with_keys_) return {.domain = domain};
  return {.domain = domain, .keys = folder() / "keys/insider", .role = "player"};
}

AttackedSystem::AttackedSystem(int domain, bool with_keys)
    : scene_(with_keys),
      domain_(std::to_string(domain)),
      attacker_(scene_.insider(domain)),
      hand_(scene_.insider(domain), 3),
      status_(attacker_.bus().reader(topics::node_status)),
      picture_(attacker_.bus().reader(topics::picture_state)) {
  std::string said;
  if (run_command(program("palpate") + " precompute " + scene_.scene(), &said) != 0) throw std::runtime_error(said);
  driver_ = std::thread([this] { drive(); });
  for (const char* name : {"deform", "render", "web", "haptic"}) start(name);
  const bool there = watch(30s, [&] { return hand_.newest().step > 800 && statuses_.size() == 4 && pictures_ > 20; });
  if (!there) throw std::runtime_error("the attacked system does not come up");
}

void AttackedSystem::start(const std::string& node) {
  const std::string terminal = scene_.folder() / (node + ".terminal");
  std::ofstream{terminal};
  terminals_.emplace(node, terminal);
  nodes_.emplace(node, ChildProcess(node, {"/bin/sh", "-c", "exec \"$@\" 2>>\"$0\"", terminal, program(node + "_node"),
                                           scene_.scene(), "--domain", domain_, "--supervised"}));
}

bool AttackedSystem::in_free_air() const {
  return hand_.newest().step < static_cast<std::uint64_t>(1000 * scene_.waits());
}

bool AttackedSystem::press() {
  if (presses_.exchange(true)) return false;
  const auto down = static_cast<std::uint64_t>(1000 * (scene_.waits() + kComesDown));
  const auto felt = [this](int tool) { return hand_.of(tool).newest().norm() > kFelt; };
  if (!watch(60s, [&] { return hand_.newest().step > down && felt(kDriven) && felt(kPressing); }))
    throw std::runtime_error("the tools do not come down");
  watch(2s);
  for (int tool = 0; tool < hand_.tools(); ++tool) hand_.of(tool).keep_undisturbed();
  return true;
}

void AttackedSystem::press_again() {
  presses_ = false;
  watch(10s, [this] { return driven_depth_ == kHover; });
  watch(500ms);
  presses_ = true;
  watch(10s, [this] { return driven_depth_ == kPressed; });
}

AttackedSystem::~AttackedSystem() {
  over_ = true;
  driver_.join();
}

// A driver as it should be: a hand that comes down, and rests.
void AttackedSystem::drive() {
  const auto device = attacker_.bus().writer(topics::device_state);
  for (DeviceState state{.tool = kDriven, .seq = 1, .depth = kHover}; !over_; ++state.seq) {
    constexpr double step = 0.005 / kComesDown * (kPressed - kHover);
    state.depth = presses_ ? std::min(kPressed, state.depth + step) : std::max(kHover, state.depth - step);
    driven_depth_ = state.depth;
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
  for (auto& [name, terminal] : terminals_) {
    terminal.clear();
    const std::string more(std::istreambuf_iterator<char>(terminal), {});
    said_[name] += more;
    fmt::print("{}", more);
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

std::map<std::string, double> AttackedSystem::memory_at_most() {
  const std::filesystem::path log = scene_.folder() / "recorder.lcmlog";
  ChildProcess recorder("record", {program("palpate"), "record", "--scene", scene_.scene(), "--domain", domain_,
                                   "--keep", "everything", "--force", "-o", log});
  const bool records = watch(60s, [&] { return std::filesystem::exists(log) && file_size(log) > kHears; });
  if (!records) throw std::runtime_error("the recorder hears nothing");
  kill(recorder.pid(), SIGSTOP);
  watch(std::chrono::milliseconds(step_depth + 500));
  const auto memory = memory_mb();
  kill(recorder.pid(), SIGCONT);
  recorder.interrupt();
  if (!recorder.wait(10s)) throw std::runtime_error("the recorder does not end");
  return memory;
}

bool AttackedSystem::is_undisturbed(std::chrono::milliseconds limit) {
  return watch(limit, [&] {
    for (int tool = 0; tool < hand_.tools(); ++tool)
      if ((hand_.of(tool).newest() - hand_.of(tool).undisturbed()).norm() > kSettled) return false;
    return true;
  });
}

bool AttackedSystem::pictures_go_on(std::chrono::milliseconds limit, const std::function<void()>& meanwhile) {
  const std::uint64_t step = hand_.newest().step, run = hand_.newest().run;
  // Not by the newest step that is known here: where the machine is busy, pictures may be told of before steps.
  const auto is_later = [&](std::uint64_t other) { return other > step && other - step < kSoon; };
  return watch(limit, [&] {
    if (meanwhile) meanwhile();
    return newest_picture_.run == run && is_later(newest_picture_.step);
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

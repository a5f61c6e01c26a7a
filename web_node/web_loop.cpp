#include "web_node/web_loop.hpp"

#include <algorithm>

#include "common/bus/task_figures.hpp"
#include "common/devices/lease.hpp"
#include "common/log/log.hpp"
#include "common/node/handling_summary.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/periodic.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/view/looks.hpp"

namespace palpate::web {
namespace {

using nlohmann::json;

constexpr unsigned kLooks = 4;                         ///< at the bus, in the time of a frame
constexpr std::int64_t kUnheardAfterNs = kNsPerS / 2;  ///< of a tool

json of(const TaskRecord& task, const Scene& scene) {
  json told{{"body", name_of(scene.bodies[task.body])}};
  for (const TaskFigure& figure : task_figures()) told[figure.key()] = figure.of(task);
  return told;
}

}  // namespace

WebLoop::WebLoop(const Scene& scene, const Eigen::Vector3d& origin, std::vector<Beginning> bodies,
                 SurfaceSource& source, Bus& bus, Presence& presence, const Hands& hands, Server& server)
    : scene_(scene),
      source_(source),
      bus_(bus),
      presence_(presence),
      hands_(hands),
      server_(server),
      clock_(bus, presence.node()),
      link_(bus),
      tools_(bus.reader(topics::tool_state)),
      forces_(bus.reader(topics::force_state)),
      bodies_(std::move(bodies)),
      frame_tools_(scene.tools.size()) {
  presence_.set_clock(&clock_);
  if (std::ranges::any_of(scene.bodies, [](const Body& body) { return has_task(body); }))
    tasks_ = bus.reader(topics::task_record);
  for (const Tool& tool : scene.tools) {
    const InstrumentView view = instrument_of(tool);
    instruments_.push_back({make_trocar(tool.pivot - origin, tool.axis, tool.up), view, make_instrument(view)});
  }
  for (const Beginning& body : bodies_)
    topologies_.push_back({body.visual ? std::vector<std::array<int, 3>>() : body.triangles, {}});
  server_.publish(topology, {false, topology_message(topology_number_, topologies_)});
}

void WebLoop::take() {
  source_.update();
  source_.watch(now_ns());
  if (topology_) follow_cuts();
  while (const auto tool = tools_->take()) take_tool(*tool);
  while (const auto force = forces_->take()) {
    const bool good = force->tool < instruments_.size() && presence_.accepts(force->run);
    if (good) instruments_[force->tool].force = *force;
    report_.samples_refused += !good;
  }
  while (const auto task = tasks_ ? tasks_->take() : std::nullopt) {
    const bool good =
        task->body < scene_.bodies.size() && has_task(scene_.bodies[task->body]) && presence_.accepts(task->run);
    if (good) latest_task_[task->body] = *task;
    report_.samples_refused += !good;
  }
}

void WebLoop::take_tool(const ToolState& state) {
  if (state.tool >= instruments_.size() || !presence_.accepts(state.run)) {
    ++report_.samples_refused;
    return;
  }
  Instrument& tool = instruments_[state.tool];
  place(tool.view, tool.trocar, state);
  tool.state = state;
  tool.seen = true;
  tool.heard_ns = now_ns();
}

void WebLoop::follow_cuts() {
  const std::vector<int> changed = topology_->take();
  for (const int body : changed) {
    if (const auto whole = whole_.find(body); whole != whole_.end()) {
      resections_.at(body) = whole->second;
      resections_.at(body).cut(topology_->cut(body));
    }
    topologies_[body].triangles = topology_->triangles(body);
    if (!bodies_[body].visual) continue;
    topologies_[body].triangles = bared(bodies_[body].triangles, topologies_[body].triangles);
    const std::span<const int> pieces = topology_->pieces(body);
    topologies_[body].pieces.assign(pieces.begin(), pieces.end());
  }
  if (changed.empty()) return;
  server_.publish(topology, {false, topology_message(++topology_number_, topologies_)});
}

FrameTool WebLoop::tool_in_frame(int index, std::int64_t now) const {
  const Instrument& tool = instruments_[index];
  const Hands::View hand = hands_.view(index, tool.state.device_seq);
  FrameTool out;
  for (int part = 0; part < 3; ++part) out.parts[part] = part_pose(tool.view, tool.shape, part).cast<float>();
  out.flags = (tool.seen ? kSeen : 0) | (hand.offered ? kOffered : 0) | (tool.state.holding ? kHolding : 0);
  if (tool.seen && now - tool.heard_ns > kUnheardAfterNs) {
    out.flags |= kUnheard;
  } else {
    for (int axis = 0; axis < 3; ++axis) out.force[axis] = static_cast<float>(tool.force.force[axis]);
    out.grip_torque = static_cast<float>(tool.force.grip);
    out.flags |= tool.force.flags;
  }
  out.sample = hand.sample;
  out.holder = hand.holder;
  out.asker = hand.asker;
  out.roll = static_cast<float>(tool.state.roll);
  out.grip = static_cast<float>(tool.state.grip);
  out.pedal = static_cast<float>(tool.state.pedal);
  return out;
}

bool WebLoop::hand_moved() const {
  for (std::size_t t = 0; t < instruments_.size(); ++t) {
    const std::uint32_t sample = hands_.view(static_cast<int>(t), instruments_[t].state.device_seq).sample;
    if (sample > frame_tools_[t].sample) return true;
  }
  return false;
}

void WebLoop::send_frame() {
  std::int64_t sense = 0;
  const std::int64_t now = now_ns();
  for (std::size_t t = 0; t < instruments_.size(); ++t) {
    frame_tools_[t] = tool_in_frame(static_cast<int>(t), now);
    sense = std::max(sense, instruments_[t].state.sense_ns);
  }
  const std::int64_t own = sense != 0 ? clock_.to_own(sense) : now;
  if (sense != last_sense_ns_) {
    report_.latency.record(now - own);
    recent_latency_.record(now - own);
    last_sense_ns_ = sense;
  }
  frame_.topology = topology_number_;
  ++frame_.number;
  frame_.sense_s = 1e-9 * static_cast<double>(own - begin_ns_);
  frame_.latency_ms = 1e-6f * static_cast<float>(now - own);
  frame_.tools = frame_tools_;
  frame_.bodies.clear();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto position = source_.shape(static_cast<int>(b)).position;
    frame_.bodies.push_back(position.empty() ? std::span<const Eigen::Vector3f>(bodies_[b].rest) : position);
  }
  server_.publish(frame, {false, encode(frame_)});
  ++report_.frames;
}

void WebLoop::keep_house(std::int64_t now) {
  for (const std::string& said : presence_.watch()) log_info(said);
  for (const std::string& said : link_.look(presence_, now)) log_warning(said);
  if (now - last_status_ns_ < kNsPerS / 2) return;
  rate_hz_ = 1e9 * static_cast<double>(report_.frames - last_frames_) / static_cast<double>(now - last_status_ns_);
  const Percentiles latency = percentiles_us(recent_latency_);
  presence_.announce(rate_hz_, report_.frames, report_.missed, latency.p50, latency.p99, link_.silence("haptic", now));
  send_status(now);
  recent_latency_.clear();
  last_status_ns_ = now;
  last_frames_ = report_.frames;
}

void WebLoop::send_status(std::int64_t now) {
  json nodes = json::array(), said = json::array(), tasks = json::array(), resections = json::array();
  if (!presence_.matched("haptic")) said.push_back("waiting for a haptic node");
  std::vector<std::string> silent;
  for (const char* role : {"haptic", "deform"})
    if (const std::string silence = link_.silence(role, now); !silence.empty()) silent.push_back(silence);
  for (const std::string& own : silent) said.push_back(own);
  const auto known = [&](const std::string& text) {
    return std::ranges::any_of(silent, [&](const std::string& own) { return LinkWatch::same_silence(own, text); });
  };
  for (const auto& [name, peer] : presence_.peers()) {
    if (!peer.accepted || now - peer.heard_ns >= 10 * kNsPerS) continue;
    const bool is_silent = now - peer.heard_ns > LinkWatch::kSilentAfterNs;
    const std::string& text = peer.status.text;
    nodes.push_back({{"role", peer.status.role},
                     {"rate_hz", peer.status.rate_hz},
                     {"silent", is_silent},
                     {"text", is_silent || known(text) ? "" : text},
                     {"driver_silent", text == kDriverSilent}});
  }
  for (const auto& [body, task] : latest_task_) tasks.push_back(of(task, scene_));
  for (const auto& [body, resection] : resections_)
    resections.push_back(resection_summary(name_of(scene_.bodies[body]), resection));
  const Percentiles latency = percentiles_us(recent_latency_);
  const Server::Seen seen = server_.seen();
  json delays;  // null where nothing came
  if (recent_latency_.count() > 0) delays = {{"p50", 1e-3 * latency.p50}, {"p99", 1e-3 * latency.p99}};
  const json status{{"nodes", nodes},
                    {"said", said},
                    {"tasks", tasks},
                    {"resections", resections},
                    {"rate_hz", rate_hz_},
                    {"latency_ms", delays},
                    {"viewers", seen.viewers},
                    {"refused", seen.refused},
                    {"malformed", seen.malformed},
                    {"skipped", seen.skipped}};
  server_.publish(web::status, {true, json{{"status", status}}.dump()});
}

const WebReport& WebLoop::run(double seconds) {
  PeriodicTimer timer(kLooks * scene_.rates.visual_hz, 0);
  std::uint64_t look = 0, sent = 0;
  begin_ns_ = last_status_ns_ = now_ns();
  std::int64_t next_house = begin_ns_;
  presence_.announce(0, 0, 0, 0, 0);
  while (!shutdown_requested()) {
    const std::int64_t now = now_ns();
    if (seconds > 0 && 1e-9 * static_cast<double>(now - begin_ns_) >= seconds) break;
    clock_.follow();
    if (now >= next_house) {
      keep_house(now);
      next_house = now + 50'000'000;
    }
    take();
    if (look - sent >= kLooks || (2 * (look - sent) >= kLooks && hand_moved())) {
      send_frame();
      sent = look;
    }
    look = timer.wait();
    report_.missed = timer.statistics().skipped / kLooks;
  }
  report_.seconds = 1e-9 * static_cast<double>(now_ns() - begin_ns_);
  report_.samples_refused += source_.refused() + bus_.refused();
  return report_;
}

}  // namespace palpate::web

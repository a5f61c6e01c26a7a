/// The other process of the tests over DDS. Usage: bus_peer publish|echo|collect|nonsense DOMAIN
#include <dds/dds.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "common/bus/dds_bus.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/periodic.hpp"
#include "common/realtime/shutdown.hpp"
#include "palpate.h"
#include "tests/bus/messages_for_tests.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using namespace palpate::testing;

/// A haptic node's topics at 1 kHz, with a surface 50 times a second; `run` is the process id.
void publish(Bus& bus) {
  const auto run = static_cast<std::uint64_t>(getpid());
  const auto tool = bus.writer(topics::tool_state);
  const auto contact = bus.writer(topics::contact_state);
  const auto force = bus.writer(topics::force_state);
  const auto surface = bus.writer(topics::surface_state);
  const auto status = bus.writer(topics::node_status);
  const auto scene = bus.writer(topics::scene);
  const auto held = bus.writer(topics::held_contacts);
  SceneText text = scene_sample();
  text.run = run;
  scene->write(text);
  held->write(contact_sample());
  NodeStatus here = status_sample("haptic " + std::to_string(run));
  here.run = run;
  status->write(here);

  ToolState t = tool_sample();
  ContactState c = contact_sample(3);
  ForceState f = force_sample();
  SurfaceState s = surface_sample(7000);
  t.run = c.run = f.run = s.run = run;
  PeriodicTimer timer(1000);
  for (std::uint64_t seq = 1; !shutdown_requested(); ++seq) {
    t.step = c.step = f.step = timer.wait();
    t.seq = c.seq = f.seq = seq;
    t.sense_ns = c.sense_ns = f.sense_ns = now_ns();
    tool->write(t);
    contact->write(c);
    force->write(f);
    if (seq % 20 != 0) continue;
    s.seq = seq / 20;
    s.sense_ns = s.publish_ns = now_ns();
    surface->write(s);
  }
}

void echo(Bus& bus) {
  const auto tool = bus.reader(topics::tool_state, Keep::all);
  const auto force = bus.writer(topics::force_state);
  ForceState answer = force_sample();
  while (!shutdown_requested()) {
    bus.wait(100ms);
    while (const auto message = tool->take()) {
      answer.seq = message->seq;
      answer.sense_ns = message->sense_ns;
      force->write(answer);
    }
  }
}

/// Keeps every sample of the 1 kHz topics without ever taking one: the laziest recorder.
void collect(Bus& bus) {
  const auto tool = bus.reader(topics::tool_state, Keep::all);
  const auto contact = bus.reader(topics::contact_state, Keep::all);
  while (!shutdown_requested()) sleep_until_ns(now_ns() + 50'000'000);
}

/// Writes what no node of ours would: past the checks of the bus.
void nonsense(int domain) {
  const std::string configuration = dds_configuration({.domain = domain});
  dds_create_domain(static_cast<dds_domainid_t>(domain), configuration.c_str());
  const dds_entity_t participant = dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr);
  const dds_entity_t topic =
      dds_create_topic(participant, &palpate_ToolState_desc, topics::tool_state.name, nullptr, nullptr);
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  const dds_entity_t writer = dds_create_writer(participant, topic, qos, nullptr);
  dds_delete_qos(qos);
  palpate_ToolState sample{};
  sample.tool = 3;
  for (std::uint64_t seq = 1; !shutdown_requested(); ++seq) {
    sample.seq = seq;
    sample.depth = seq % 2 == 1 ? std::nan("") : 0.25;
    dds_write(writer, &sample);
    sleep_until_ns(now_ns() + 20'000'000);
  }
  dds_delete(participant);
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  using namespace palpate;
  if (argc != 3) return 2;
  catch_shutdown_signals();
  const std::string role = argv[1];
  const int domain = std::atoi(argv[2]);
  if (role == "nonsense") {
    nonsense(domain);
    return 0;
  }
  const auto bus = make_dds_bus({.domain = domain});
  if (role == "publish") publish(*bus);
  if (role == "echo") echo(*bus);
  if (role == "collect") collect(*bus);
  return 0;
}

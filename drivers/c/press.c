/* A driver in C: publishes a tool's position a thousand times a second and takes the force for the motors.
 *   CYCLONEDDS_URI="$(palpate network SCENE)" press [TOOL [FROM TO]]
 * TOOL: its place in the scene's list, from 0. FROM, TO: depths beyond the trocar [m], between which the emulated
 * hardware goes in and out. To drive hardware of your own, replace read_position() and drive_motors(). */
#include <dds/dds.h>
#include <math.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "palpate.h"

static const int64_t NS_PER_S = 1000000000;
static const int64_t PERIOD_NS = 1000000;  /* of the loop: 1 kHz */
static const int64_t SILENCE_NS = 100000000; /* without a force for so long, the motors go limp */

static volatile sig_atomic_t stopped = 0;

static void stop(int signal) {
  (void)signal;
  stopped = 1;
}

/* CLOCK_MONOTONIC [ns], the clock of all messages. */
static int64_t now_ns(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * NS_PER_S + t.tv_nsec;
}

static void fail(const char *what, dds_return_t code) {
  fprintf(stderr, "press: %s: %s\n", what, dds_strretcode(-code));
  exit(1);
}

static dds_entity_t checked(const char *what, dds_entity_t entity) {
  if (entity < 0) fail(what, entity);
  return entity;
}

/* The hardware, here an emulated one: in and out within four seconds. */
static void read_position(double seconds, double from, double to, palpate_DeviceState *state) {
  const double pi = acos(-1);
  state->depth = from + (to - from) * 0.5 * (1 - cos(2 * pi * seconds / 4));
}

/* The motors, here an emulated one: remembers the largest force [N]. */
static double largest = 0;
static void drive_motors(const double force[3]) {
  largest = fmax(largest, sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]));
}

/* Takes what has come; 1 if a force for this tool was among it. */
static int take_force(dds_entity_t reader, uint32_t tool) {
  void *samples[16] = {NULL};
  dds_sample_info_t infos[16];
  int heard = 0;
  const dds_return_t count = dds_take(reader, samples, infos, 16, 16);
  for (int i = 0; i < count; ++i) {
    const palpate_ForceState *force = samples[i];
    if (!infos[i].valid_data || force->tool != tool) continue;
    drive_motors(force->force);
    heard = 1;
  }
  if (count > 0) dds_return_loan(reader, samples, count);
  return heard;
}

static void loop(dds_entity_t writer, dds_entity_t reader, uint32_t tool, double from, double to) {
  palpate_DeviceState state = {.tool = tool};
  const int64_t begin = now_ns();
  int64_t next = begin, heard_ns = begin;
  int limp = 1; /* until the first force */
  while (!stopped) {
    state.seq++;
    state.sense_ns = now_ns(); /* of the reading: what follows tells its age by it */
    read_position(1e-9 * (double)(state.sense_ns - begin), from, to, &state);
    state.publish_ns = now_ns();
    const dds_return_t written = dds_write(writer, &state);
    if (written < 0 && written != DDS_RETCODE_TIMEOUT) fail("writing", written);

    if (take_force(reader, tool)) {
      heard_ns = now_ns();
      limp = 0;
    } else if (!limp && now_ns() - heard_ns > SILENCE_NS) {
      const double none[3] = {0, 0, 0};
      drive_motors(none);
      limp = 1;
      printf("limp: no force for 100 ms\n");
      fflush(stdout);
    }
    next += PERIOD_NS;
    const struct timespec until = {next / NS_PER_S, next % NS_PER_S};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL);
  }
  printf("%llu samples, the largest force %.3f N\n", (unsigned long long)state.seq, largest);
}

int main(int argc, char **argv) {
  const uint32_t tool = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 0;
  const double from = argc > 2 ? strtod(argv[2], NULL) : 0.10;
  const double to = argc > 3 ? strtod(argv[3], NULL) : 0.12;
  signal(SIGINT, stop);
  signal(SIGTERM, stop);

  /* Domain and network come from CYCLONEDDS_URI. */
  const dds_entity_t participant = checked("participant", dds_create_participant(DDS_DOMAIN_DEFAULT, NULL, NULL));
  dds_qos_t *reliable = dds_create_qos(), *newest = dds_create_qos();
  dds_qset_reliability(reliable, DDS_RELIABILITY_RELIABLE, 0);
  dds_qset_history(reliable, DDS_HISTORY_KEEP_LAST, 2048);
  dds_qset_reliability(newest, DDS_RELIABILITY_BEST_EFFORT, 0);
  const dds_entity_t device_topic = checked(
      "topic", dds_create_topic(participant, &palpate_DeviceState_desc, "palpate/device_state", NULL, NULL));
  const dds_entity_t force_topic =
      checked("topic", dds_create_topic(participant, &palpate_ForceState_desc, "palpate/force_state", NULL, NULL));
  const dds_entity_t writer = checked("writer", dds_create_writer(participant, device_topic, reliable, NULL));
  const dds_entity_t reader = checked("reader", dds_create_reader(participant, force_topic, newest, NULL));

  loop(writer, reader, tool, from, to);
  dds_delete_qos(reliable);
  dds_delete_qos(newest);
  dds_delete(participant);
  return 0;
}

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
#include <string.h>
#include <time.h>

#include "palpate.h"

static const int64_t NS_PER_S = 1000000000;
static const int64_t PERIOD_NS = 1000000; /* of the loop: 1 kHz */
static const double TICK = 0.001;         /* the same [s] */

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

static void fail(const char* what, dds_return_t code) {
  fprintf(stderr, "press: %s: %s\n", what, dds_strretcode(-code));
  exit(1);
}

static dds_entity_t checked(const char* what, dds_entity_t entity) {
  if (entity < 0) fail(what, entity);
  return entity;
}

/* The hardware, here an emulated one: in and out within four seconds. */
static void read_position(double seconds, double from, double to, palpate_DeviceState* state) {
  const double pi = acos(-1);
  state->depth = from + (to - from) * 0.5 * (1 - cos(2 * pi * seconds / 4));
}

/* The motors, here emulated ones: they remember the largest force and the largest change in a tick [N]. */
static double largest = 0, change = 0;
static double size(const double v[3]) {
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}
static void drive_motors(const double force[3]) {
  static double last[3];
  const double by[3] = {force[0] - last[0], force[1] - last[1], force[2] - last[2]};
  largest = fmax(largest, size(force));
  change = fmax(change, size(by));
  memcpy(last, force, sizeof last);
}

/* What the motors give, whatever is said on the network. */
static const double MAX_FORCE = 10;           /* [N]; ten times that is no force for this device */
static const double MAX_RATE = 500;           /* [N/s] at which the force rises or turns */
static const int64_t SILENCE_NS = 20000000;   /* without a force for so long, it fades */
static const double FADE = 0.02, BACK = 0.05; /* [s] from all to nothing, and back */

struct motors {
  int follows;                         /* a haptic loop, until it has been silent and its force is gone */
  uint64_t run;                        /* of that loop */
  uint64_t step;                       /* of it, told last */
  int catches_up;                      /* with a force of which steps were missing */
  int64_t heard_ns;                    /* when it was heard last */
  double told[3];                      /* [N] then */
  double share;                        /* of it that the motors give */
  double given[3];                     /* [N] */
  unsigned long long strange, refused; /* forces of other loops; those that cannot be */
};

static void hear(struct motors* m, const palpate_ForceState* said) {
  const double newtons = size(said->force);
  if (m->follows && said->run != m->run) {
    m->strange++;
  } else if (!(newtons <= 10 * MAX_FORCE)) { /* nor what is no number */
    m->refused++;
  } else {
    for (int k = 0; k < 3; ++k) m->told[k] = said->force[k] * (newtons > MAX_FORCE ? MAX_FORCE / newtons : 1);
    m->catches_up |= said->step > m->step + 5;
    m->step = said->step;
    m->follows = 1;
    m->run = said->run;
    m->heard_ns = now_ns();
  }
}

/* Once a tick. From step to step the force falls as fast as it is told, since the haptic node bounds that. */
static void give(struct motors* m) {
  const int silent = !m->follows || now_ns() - m->heard_ns > SILENCE_NS;
  m->share = silent ? fmax(0, m->share - TICK / FADE) : fmin(1, m->share + TICK / BACK);
  if (silent && m->share == 0) m->follows = 0;
  const double wanted = m->share * size(m->told), before = size(m->given);
  const double falls = wanted < before && !m->catches_up ? wanted / before : 1;
  double by[3];
  for (int k = 0; k < 3; ++k) by[k] = m->share * m->told[k] - (m->given[k] *= falls);
  const double ticks = fmax(1, size(by) / (MAX_RATE * TICK)); /* until all of it is there */
  m->catches_up = m->catches_up && ticks > 1;
  for (int k = 0; k < 3; ++k) m->given[k] += by[k] / ticks;
  drive_motors(m->given);
}

/* Hears what has come for this tool. */
static void take_forces(dds_entity_t reader, uint32_t tool, struct motors* motors) {
  void* samples[64] = {NULL};
  dds_sample_info_t infos[64];
  const dds_return_t count = dds_take(reader, samples, infos, 64, 64);
  for (int i = 0; i < count; ++i) {
    const palpate_ForceState* force = samples[i];
    if (infos[i].valid_data && force->tool == tool) hear(motors, force);
  }
  if (count > 0) dds_return_loan(reader, samples, count);
}

static void loop(dds_entity_t writer, dds_entity_t reader, uint32_t tool, double from, double to) {
  palpate_DeviceState state = {.tool = tool};
  struct motors motors = {0};
  const int64_t begin = now_ns();
  int64_t next = begin;
  int limp = 1;                          /* until the first force */
  while (!stopped || motors.share > 0) { /* no kick at the end either */
    if (!stopped) {
      state.seq++;
      state.sense_ns = now_ns(); /* of the reading: what follows tells its age by it */
      read_position(1e-9 * (double)(state.sense_ns - begin), from, to, &state);
      state.publish_ns = now_ns();
      const dds_return_t written = dds_write(writer, &state);
      if (written < 0 && written != DDS_RETCODE_TIMEOUT) fail("writing", written);
      take_forces(reader, tool, &motors);
    }
    give(&motors);
    if (motors.share == 0 && !limp) {
      printf("limp: no force for 40 ms\n");
      fflush(stdout);
    }
    limp = motors.share == 0;
    next += PERIOD_NS;
    const struct timespec until = {next / NS_PER_S, next % NS_PER_S};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL);
  }
  printf("%llu samples, the largest force %.3f N, the largest change %.3f N\n", (unsigned long long)state.seq, largest,
         change);
  printf("not felt: %llu forces of another run, %llu out of range\n", motors.strange, motors.refused);
}

/* The whole argument at a place as a number, or what stands for it where there is none. */
static double number(int argc, char** argv, int place, const char* name, double otherwise) {
  if (argc <= place) return otherwise;
  char* end = NULL;
  const double value = strtod(argv[place], &end);
  if (end == argv[place] || *end != '\0' || !(value >= 0 && value <= 1e9)) {
    fprintf(stderr, "press: %s is a number from 0, and not '%s'\n", name, argv[place]);
    exit(1);
  }
  return value;
}

int main(int argc, char** argv) {
  if (argc > 4) {
    fprintf(stderr, "press: too many arguments: press [TOOL [FROM TO]]\n");
    return 1;
  }
  const uint32_t tool = (uint32_t)number(argc, argv, 1, "TOOL", 0);
  const double from = number(argc, argv, 2, "FROM", 0.10), to = number(argc, argv, 3, "TO", 0.12);
  signal(SIGINT, stop);
  signal(SIGTERM, stop);

  /* Domain and network come from CYCLONEDDS_URI. */
  const dds_entity_t participant = checked("participant", dds_create_participant(DDS_DOMAIN_DEFAULT, NULL, NULL));
  dds_qos_t *reliable = dds_create_qos(), *lossy = dds_create_qos();
  dds_qset_reliability(reliable, DDS_RELIABILITY_RELIABLE, 0);
  dds_qset_history(reliable, DDS_HISTORY_KEEP_LAST, 2048);
  dds_qset_reliability(lossy, DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_history(lossy, DDS_HISTORY_KEEP_LAST, 16); /* another's force does not hide the one that is followed */
  const dds_entity_t device_topic =
      checked("topic", dds_create_topic(participant, &palpate_DeviceState_desc, "palpate/device_state", NULL, NULL));
  const dds_entity_t force_topic =
      checked("topic", dds_create_topic(participant, &palpate_ForceState_desc, "palpate/force_state", NULL, NULL));
  const dds_entity_t writer = checked("writer", dds_create_writer(participant, device_topic, reliable, NULL));
  const dds_entity_t reader = checked("reader", dds_create_reader(participant, force_topic, lossy, NULL));

  loop(writer, reader, tool, from, to);
  dds_delete_qos(reliable);
  dds_delete_qos(lossy);
  dds_delete(participant);
  return 0;
}

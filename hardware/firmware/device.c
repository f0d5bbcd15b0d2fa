#include "device.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "clock.h"
#include "link.h"
#include "load_cells.h"
#include "measure.h"
#include "memory.h"
#include "plates.h"
#include "protocol.h"
#include "start.h"

#ifndef SERIAL_NUMBER
#define SERIAL_NUMBER 1
#endif

enum { FIRMWARE_MAJOR = 0, FIRMWARE_MINOR = 2 };
enum { STEP_PV = 7812500, LIMIT_NV = 256000000 };
enum { SECOND_US = 1000000, TESTED = 64, REMEMBERED = 8 };
enum { SILENCE_US = 10 * SECOND_US }; // without a sign of the host, after which the setpoints end
enum {
  CHECKS = CHECK_CONVERTER | 3 * CHECK_LEFT_THERMISTOR | CHECK_LOAD_CELLS | CHECK_MEMORY | CHECK_BROWN_OUT
};

static struct measured measured = {.supply = 5.0f};
static bool unidentified = true, memory_good;
static uint32_t host_seen; // when, last
static bool host_silent;

static uint16_t rate, phase, session, boots;
static bool has_session;
static uint32_t samples, uptime, second;
static uint16_t overruns, repeats;

static struct {
  uint16_t command;
  uint8_t result;
} executed[REMEMBERED];
static uint8_t executed_next, executed_count;
static struct header storing; // the command that set the constants being stored
static bool told_to_store;    // else they are being mended

static struct {
  uint16_t checks;
  uint8_t count; // of samples, 0 while no test runs
  float mean[SIDES], squares[SIDES];
} test;

// The part of a condition that is for the left fingertip, as a mask for both.
static uint8_t each(uint8_t left, bool is_left, bool is_right) {
  return (uint8_t)((is_left ? left : 0) | (is_right ? left << 1 : 0));
}

static bool saturated(uint8_t side) {
  return measured.element[side] == INT16_MAX || measured.element[side] == INT16_MIN;
}

static uint8_t flags(void) {
  return (uint8_t)(each(SATURATED_LEFT, saturated(0), saturated(1)) |
                   each(OPEN_LEFT, plate_broken(0), plate_broken(1)) |
                   each(OFF_SETPOINT_LEFT, plate_off_setpoint(0), plate_off_setpoint(1)) |
                   (plates_latched() ? LATCHED_OFF : 0) | (unidentified ? UNIDENTIFIED : 0));
}

static bool send(uint8_t code, const void *payload, uint8_t length, uint32_t us) {
  return link_send(code, flags(), payload, length, us);
}

static void send_identity(bool common) {
  struct identity identity = {
      .model = MODEL,
      .protocol = {common ? PROTOCOL_MAJOR : 0, common ? PROTOCOL_MINOR : 0},
      .firmware = {FIRMWARE_MAJOR, FIRMWARE_MINOR},
      .boots = boots,
      .max_rate = CYCLE_HZ,
      .serial = SERIAL_NUMBER,
      .voltage_step = STEP_PV,
      .voltage_limit = LIMIT_NV,
  };
  send(IDENTITY, &identity, sizeof identity, clock_us());
}

static void send_thermostats(void) {
  struct thermostat_report report;
  plates_report(&report);
  send(THERMOSTAT, &report, sizeof report, clock_us());
}

static void send_status(void) {
  struct status status = {
      .uptime = uptime,
      .samples = samples,
      .overruns = overruns,
      .bad_frames = link_bad_frames(),
      .repeats = repeats,
      .supply = (uint16_t)(measured.supply * 1000.0f + 0.5f),
      .rate = rate,
  };
  send(STATUS, &status, sizeof status, clock_us());
}

static void send_condition(void) {
  struct condition condition = {
      .reset = start_cause(),
      .heaters_off = (uint8_t)(plates_latched() | (host_silent ? HOST_SILENT : 0)),
  };
  send(CONDITION, &condition, sizeof condition, clock_us());
}

static void send_sample(void) {
  struct sample sample;
  for (uint8_t side = 0; side < SIDES; ++side) {
    int32_t half_nanovolts = (int32_t)measured.element[side] * 15625;
    sample.voltage[side] = measured.element_known[side] ? half_nanovolts / 2 : MISSING32;
    sample.thermostat[side] = plate_temperature(side);
  }
  load_cells_read(sample.force);
  if (send(SAMPLE, &sample, sizeof sample, measured.us)) {
    ++samples;
  } else {
    ++overruns;
  }
}

static void send_self_test(void) {
  struct self_test result = {.checks = test.checks};
  int16_t force[SIDES][AXES];
  bool converter = measured.element_known[0] && measured.element_known[1] && !saturated(0) && !saturated(1);
  uint16_t failed = (converter ? 0 : CHECK_CONVERTER) | each(CHECK_LEFT_THERMISTOR, plate_broken(0), plate_broken(1)) |
                    (load_cells_read(force) ? 0 : CHECK_LOAD_CELLS) | (memory_good ? 0 : CHECK_MEMORY) |
                    (start_guarded() ? 0 : CHECK_BROWN_OUT);
  result.failed = failed & test.checks;
  for (uint8_t side = 0; side < SIDES; ++side)
    result.voltage_noise[side] = (uint32_t)(sqrtf(test.squares[side] / TESTED) * (STEP_PV / 1000.0f));
  send(SELF_TEST, &result, sizeof result, clock_us());
}

// Another sample of the running self-test; mean and sum of squared deviations as Welford has them.
static void test_cycle(void) {
  if (test.count == 0) return;
  uint8_t taken = (uint8_t)(TESTED - test.count + 1);
  for (uint8_t side = 0; side < SIDES; ++side) {
    float deviation = (float)measured.element[side] - test.mean[side];
    test.mean[side] += deviation / taken;
    test.squares[side] += deviation * ((float)measured.element[side] - test.mean[side]);
  }
  if (--test.count == 0) send_self_test();
}

static uint8_t set_rate(const uint8_t *payload) {
  uint16_t wanted;
  memcpy(&wanted, payload, sizeof wanted);
  if (wanted > CYCLE_HZ) return BAD_VALUE;
  rate = wanted;
  phase = 0;
  return DONE;
}

static uint8_t set_setpoint(const uint8_t *payload) {
  int16_t wanted[SIDES];
  memcpy(wanted, payload, sizeof wanted);
  if (!plates_set(wanted)) return BAD_VALUE;
  host_seen = clock_us();
  host_silent = false;
  return DONE;
}

static void keep_alive(const uint8_t *payload) {
  uint16_t of;
  memcpy(&of, payload, sizeof of);
  if (has_session && of == session) host_seen = clock_us();
}

static uint8_t run_self_test(const uint8_t *payload) {
  if (test.count) return BUSY;
  memset(&test, 0, sizeof test);
  memcpy(&test.checks, payload, sizeof test.checks);
  test.checks &= CHECKS;
  test.count = TESTED;
  return DONE;
}

static uint8_t request(uint8_t wanted) {
  uint8_t constants[CONSTANTS];
  switch (wanted) {
  case THERMOSTAT:
    send_thermostats();
    return DONE;
  case STATUS:
    send_status();
    return DONE;
  case CALIBRATION:
    memory_constants(constants);
    send(CALIBRATION, constants, CONSTANTS, clock_us());
    return DONE;
  case CONDITION:
    send_condition();
    return DONE;
  default:
    return BAD_VALUE;
  }
}

static uint8_t identify(const uint8_t *payload) {
  struct identify host;
  memcpy(&host, payload, sizeof host);
  unidentified = false;
  if (!has_session || host.session != session) executed_count = executed_next = 0;
  has_session = true;
  session = host.session;
  send_identity(host.oldest <= PROTOCOL_MAJOR && PROTOCOL_MAJOR <= host.newest);
  return DONE;
}

static void acknowledge(const struct header *command, uint8_t result) {
  struct acknowledgement answer = {.command = command->sequence, .code = command->code, .result = result};
  send(ACKNOWLEDGEMENT, &answer, sizeof answer, clock_us());
}

static void remember(uint16_t command, uint8_t result) {
  executed[executed_next].command = command;
  executed[executed_next].result = result;
  executed_next = (uint8_t)((executed_next + 1) % REMEMBERED);
  if (executed_count < REMEMBERED) ++executed_count;
}

static void execute(const struct header *command, const uint8_t *payload) {
  uint8_t result;
  if (command->code == KEEP_ALIVE) {
    keep_alive(payload);
    return;
  }
  if (command->code == IDENTIFY || command->code == REQUEST) { // they only read
    result = command->code == IDENTIFY ? identify(payload) : request(payload[0]);
    acknowledge(command, result);
    return;
  }
  for (uint8_t i = 0; i < executed_count; ++i) {
    if (executed[i].command == command->sequence) {
      ++repeats;
      acknowledge(command, executed[i].result);
      return;
    }
  }
  if (command->code == SET_CALIBRATION) {
    if (memory_storing()) {
      if (told_to_store && storing.sequence == command->sequence) {
        ++repeats; // acknowledged at the end
      } else {
        acknowledge(command, BUSY);
      }
      return;
    }
    memory_store(payload);
    storing = *command;
    told_to_store = true;
    return;
  }
  result = command->code == SET_RATE       ? set_rate(payload)
           : command->code == SET_SETPOINT ? set_setpoint(payload)
           : command->code == CLEAR_FAULTS ? (plates_clear(payload[0]) ? DONE : FAILED)
                                           : run_self_test(payload);
  if (result != BUSY) remember(command->sequence, result);
  acknowledge(command, result);
}

void device_begin(void) {
  uint8_t constants[CONSTANTS];
  boots = memory_begin();
  memory_good = memory_constants(constants);
  second = clock_us() + SECOND_US;
  send_identity(true);
}

void device_poll(void) {
  struct header command;
  const uint8_t *payload;
  while ((payload = link_receive(&command))) execute(&command, payload);
  if (plates_on() && reached(host_seen + SILENCE_US)) {
    plates_off();
    host_silent = true;
  }
  if (memory_poll() && told_to_store) {
    told_to_store = false;
    memory_good = true;
    remember(storing.sequence, DONE);
    acknowledge(&storing, DONE);
  }
  if (!measure_poll(&measured)) return;
  plates_cycle(&measured);
  memory_latch(plates_latched()); // before the next start, whatever causes it
  test_cycle();
  phase += rate;
  if (phase >= CYCLE_HZ) {
    phase -= CYCLE_HZ;
    send_sample();
  }
  if (reached(second)) { // here, where the converters have just begun: nothing waits
    second += SECOND_US;
    ++uptime;
    if (rate) {
      send_thermostats();
      send_status();
      send_condition();
    }
  }
}

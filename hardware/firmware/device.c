#include "device.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "clock.h"
#include "frame.h"
#include "heaters.h"
#include "load_cells.h"
#include "measure.h"
#include "memory.h"
#include "protocol.h"
#include "serial.h"
#include "thermistor.h"
#include "thermostat.h"

#ifndef SERIAL_NUMBER
#define SERIAL_NUMBER 1
#endif

#define HEATER_OHMS 5.0f
#define OFF_BY 1.0f // K
enum { FIRMWARE_MAJOR = 0, FIRMWARE_MINOR = 1 };
enum { STEP_PV = 7812500, LIMIT_NV = 256000000 };
enum { SECOND_US = 1000000, CYCLES_A_CONTROL = 2, TESTED = 64, REMEMBERED = 8, HIGHEST_SETPOINT = 6000 };
enum { CHECKS = CHECK_CONVERTER | 3 * CHECK_LEFT_THERMISTOR | CHECK_LOAD_CELLS | CHECK_MEMORY };

_Static_assert((float)CYCLES_A_CONTROL / CYCLE_HZ == CONTROL_STEP, "the thermostats' step");

static struct measured measured = {.supply = 5.0f};
static struct thermostat thermostats[SIDES];
static float sums[SIDES];     // of temperatures since the last control step
static uint8_t cycles;        // since then
static uint8_t broken_cycles[SIDES];
static bool broken[SIDES], hot, unidentified = true, memory_good;

static uint16_t sequence, rate, phase, session, boots;
static bool has_session;
static uint32_t samples, uptime, second;
static uint16_t overruns, repeats;

static struct {
  uint16_t command;
  uint8_t result;
} executed[REMEMBERED];
static uint8_t executed_next, executed_count;
static struct header storing; // the command that set the constants being stored

static struct {
  uint16_t checks;
  uint8_t count; // of samples, 0 while no test runs
  float mean[SIDES], squares[SIDES];
} test;

static struct receiver receiver;

// The part of a condition that is for the left fingertip, as a mask for both.
static uint8_t each(uint8_t left, bool is_left, bool is_right) {
  return (uint8_t)((is_left ? left : 0) | (is_right ? left << 1 : 0));
}

static bool saturated(uint8_t side) {
  return measured.element[side] == INT16_MAX || measured.element[side] == INT16_MIN;
}

static bool off_setpoint(uint8_t side) {
  const struct thermostat *t = &thermostats[side];
  return t->on && !broken[side] && fabsf(t->measured - t->setpoint) > OFF_BY;
}

static uint8_t flags(void) {
  return (uint8_t)(each(SATURATED_LEFT, saturated(0), saturated(1)) | each(OPEN_LEFT, broken[0], broken[1]) |
                   each(OFF_SETPOINT_LEFT, off_setpoint(0), off_setpoint(1)) | (hot ? OVER_TEMPERATURE : 0) |
                   (unidentified ? UNIDENTIFIED : 0));
}

// Sends a frame whole or not at all.
static bool send(uint8_t code, const void *payload, uint8_t length, uint32_t us) {
  uint8_t block[FRAME_LONGEST], stuffed[FRAME_LONGEST + 1];
  struct header header = {.code = code, .flags = flags(), .sequence = sequence, .device_us = us};
  uint8_t size = (uint8_t)(sizeof header + length);
  if (serial_room() < size + FRAME_CRC + 3) return false;
  memcpy(block, &header, sizeof header);
  memcpy(block + sizeof header, payload, length);
  uint32_t crc = crc32(block, size);
  memcpy(block + size, &crc, FRAME_CRC);
  size += FRAME_CRC;
  cobs_encode(block, size, stuffed);
  serial_put(0);
  for (uint8_t i = 0; i <= size; ++i) serial_put(stuffed[i]);
  serial_put(0);
  ++sequence;
  return true;
}

static int16_t hundredths(float value) { return (int16_t)lrintf(value * 100.0f); }

static int16_t temperature(uint8_t side) { return broken[side] ? MISSING16 : hundredths(thermostats[side].measured); }

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
  for (uint8_t side = 0; side < SIDES; ++side) {
    const struct thermostat *t = &thermostats[side];
    report.setpoint[side] = t->on ? hundredths(t->setpoint) : MISSING16;
    report.temperature[side] = temperature(side);
    report.power[side] = (uint16_t)(t->power * 1000.0f + 0.5f);
  }
  send(THERMOSTAT, &report, sizeof report, clock_us());
}

static void send_status(void) {
  struct status status = {
      .uptime = uptime,
      .samples = samples,
      .overruns = overruns,
      .bad_frames = receiver.bad,
      .repeats = repeats,
      .supply = (uint16_t)(measured.supply * 1000.0f + 0.5f),
      .rate = rate,
  };
  send(STATUS, &status, sizeof status, clock_us());
}

static void send_sample(void) {
  struct sample sample;
  for (uint8_t side = 0; side < SIDES; ++side) {
    int32_t half_nanovolts = (int32_t)measured.element[side] * 15625;
    sample.voltage[side] = measured.element_known[side] ? half_nanovolts / 2 : MISSING32;
    sample.thermostat[side] = temperature(side);
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
  uint16_t failed = (converter ? 0 : CHECK_CONVERTER) | each(CHECK_LEFT_THERMISTOR, broken[0], broken[1]) |
                    (load_cells_read(force) ? 0 : CHECK_LOAD_CELLS) | (memory_good ? 0 : CHECK_MEMORY);
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

static void control_cycle(void) {
  for (uint8_t side = 0; side < SIDES; ++side) {
    if (thermistor_broken(measured.part[side])) {
      ++broken_cycles[side];
    } else {
      sums[side] += thermistor_temperature(measured.part[side]);
    }
  }
  if (++cycles < CYCLES_A_CONTROL) return;
  float full = measured.supply * measured.supply / HEATER_OHMS; // W
  for (uint8_t side = 0; side < SIDES; ++side) {
    struct thermostat *t = &thermostats[side];
    uint8_t good = (uint8_t)(cycles - broken_cycles[side]);
    broken[side] = good == 0;
    float power = thermostat_step(t, good ? sums[side] / good : t->measured, broken[side] || hot);
    hot |= !broken[side] && t->measured >= TOO_HOT;
    heater_set(side, power / full);
    sums[side] = 0.0f;
    broken_cycles[side] = 0;
  }
  cycles = 0;
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
  for (uint8_t side = 0; side < SIDES; ++side)
    if (wanted[side] != MISSING16 && (wanted[side] < 0 || wanted[side] > HIGHEST_SETPOINT)) return BAD_VALUE;
  for (uint8_t side = 0; side < SIDES; ++side) {
    thermostats[side].on = wanted[side] != MISSING16;
    thermostats[side].setpoint = wanted[side] / 100.0f;
  }
  hot = false;
  return DONE;
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
      if (storing.sequence == command->sequence) {
        ++repeats; // acknowledged at the end
      } else {
        acknowledge(command, BUSY);
      }
      return;
    }
    memory_store(payload);
    storing = *command;
    return;
  }
  result = command->code == SET_RATE       ? set_rate(payload)
           : command->code == SET_SETPOINT ? set_setpoint(payload)
                                           : run_self_test(payload);
  if (result != BUSY) remember(command->sequence, result);
  acknowledge(command, result);
}

static uint8_t payload_length(uint8_t code) { // 0: not a command
  switch (code) {
  case IDENTIFY:
  case SET_SETPOINT:
    return 4;
  case REQUEST:
    return 1;
  case SET_RATE:
  case RUN_SELF_TEST:
    return 2;
  case SET_CALIBRATION:
    return CONSTANTS;
  default:
    return 0;
  }
}

static void listen(void) {
  uint8_t byte;
  while (serial_take(&byte)) {
    uint8_t length = receive(&receiver, byte);
    if (length == 0) continue;
    struct header command;
    memcpy(&command, receiver.bytes, sizeof command);
    uint8_t payload = payload_length(command.code);
    if (payload && length == sizeof command + payload) {
      execute(&command, receiver.bytes + sizeof command);
    } else {
      ++receiver.bad;
    }
  }
}

void device_begin(void) {
  uint8_t constants[CONSTANTS];
  boots = memory_begin();
  memory_good = memory_constants(constants);
  second = clock_us() + SECOND_US;
  send_identity(true);
}

void device_poll(void) {
  listen();
  if (memory_poll()) {
    memory_good = true;
    remember(storing.sequence, DONE);
    acknowledge(&storing, DONE);
  }
  if (!measure_poll(&measured)) return;
  control_cycle();
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
    }
  }
}

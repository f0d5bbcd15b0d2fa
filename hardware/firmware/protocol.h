// The messages of docs/protocol.md as they lie in a frame: little-endian and packed, as this processor has them anyway.
#pragma once

#include <stdint.h>

enum {
  SAMPLE = 0x01,
  THERMOSTAT = 0x02,
  STATUS = 0x03,
  IDENTITY = 0x04,
  CALIBRATION = 0x05,
  SELF_TEST = 0x06,
  ACKNOWLEDGEMENT = 0x07,
  CONDITION = 0x08,
  IDENTIFY = 0x81,
  REQUEST = 0x82,
  SET_RATE = 0x83,
  SET_SETPOINT = 0x84,
  SET_CALIBRATION = 0x85,
  RUN_SELF_TEST = 0x86,
  CLEAR_FAULTS = 0x87,
  KEEP_ALIVE = 0x88,
};

enum {
  SATURATED_LEFT = 0x01,
  OPEN_LEFT = 0x04,
  OFF_SETPOINT_LEFT = 0x10,
  LATCHED_OFF = 0x40,
  UNIDENTIFIED = 0x80,
};

enum { RESET_ANY = 0x0F };                                          // as the processor has them
enum { TOO_HOT_LEFT = 0x01, RUNAWAY_LEFT = 0x04, LATCHING = 0x0F, HOST_SILENT = 0x10 }; // why heaters are off

enum { DONE, BAD_VALUE, BUSY, FAILED };

enum {
  CHECK_CONVERTER = 0x01,
  CHECK_LEFT_THERMISTOR = 0x02,
  CHECK_LOAD_CELLS = 0x20,
  CHECK_MEMORY = 0x40,
  CHECK_BROWN_OUT = 0x80,
};

enum { MODEL = 0x5447, PROTOCOL_MAJOR = 2, PROTOCOL_MINOR = 0 };
enum { SIDES = 2, AXES = 3, CONSTANTS = 48 };

#define MISSING16 INT16_MIN
#define MISSING32 INT32_MIN

struct __attribute__((packed)) header {
  uint8_t code, flags;
  uint16_t sequence;
  uint32_t device_us;
};

struct __attribute__((packed)) sample {
  int32_t voltage[SIDES];     // nV
  int16_t thermostat[SIDES];  // 0.01 degC
  int16_t force[SIDES][AXES]; // 0.01 N
};

struct __attribute__((packed)) thermostat_report {
  int16_t setpoint[SIDES], temperature[SIDES]; // 0.01 degC
  uint16_t power[SIDES];                       // mW
};

struct __attribute__((packed)) status {
  uint32_t uptime, samples; // s, -
  uint16_t overruns, bad_frames, repeats, supply, rate;
};

struct __attribute__((packed)) identity {
  uint16_t model;
  uint8_t protocol[2], firmware[2];
  uint16_t boots, max_rate;
  uint64_t serial;
  uint32_t voltage_step, voltage_limit; // pV, nV
};

struct __attribute__((packed)) self_test {
  uint16_t checks, failed;
  uint32_t voltage_noise[SIDES]; // nV
  uint16_t heater_current[SIDES];
};

struct __attribute__((packed)) acknowledgement {
  uint16_t command;
  uint8_t code, result;
};

struct __attribute__((packed)) condition {
  uint8_t reset, heaters_off;
};

struct __attribute__((packed)) identify {
  uint8_t oldest, newest;
  uint16_t session;
};

_Static_assert(sizeof(struct header) == 8 && sizeof(struct sample) == 24, "protocol.md");
_Static_assert(sizeof(struct thermostat_report) == 12 && sizeof(struct status) == 18, "protocol.md");
_Static_assert(sizeof(struct identity) == 26 && sizeof(struct self_test) == 16, "protocol.md");
_Static_assert(sizeof(struct acknowledgement) == 4 && sizeof(struct identify) == 4, "protocol.md");
_Static_assert(sizeof(struct condition) == 2, "protocol.md");

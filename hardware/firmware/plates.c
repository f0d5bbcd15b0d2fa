#include "plates.h"

#include <math.h>

#include "heaters.h"
#include "runaway.h"
#include "thermistor.h"
#include "thermostat.h"

#define HEATER_OHMS 5.0f
enum { CYCLES_A_STEP = 2, HIGHEST_SETPOINT = 6000 };

_Static_assert((float)CYCLES_A_STEP / CYCLE_HZ == CONTROL_STEP, "the thermostats' step");

static struct thermostat thermostats[SIDES];
static float sums[SIDES]; // of temperatures since the last step
static uint8_t good[SIDES], cycles;
static bool broken[SIDES];
static struct runaway watched[SIDES];
static uint8_t latched;

void plates_begin(uint8_t faults) {
  latched = faults & LATCHING;
  heaters_begin();
}

static bool too_hot(uint8_t side) { return !broken[side] && thermostats[side].measured >= TOO_HOT; }

static void control(uint8_t side, float full) {
  struct thermostat *t = &thermostats[side];
  broken[side] = good[side] == 0;
  float power = thermostat_step(t, broken[side] ? t->measured : sums[side] / good[side], broken[side] || latched);
  if (too_hot(side)) latched |= (uint8_t)(TOO_HOT_LEFT << side);
  if (runaway_step(&watched[side], t)) latched |= (uint8_t)(RUNAWAY_LEFT << side);
  heater_set(side, latched ? 0.0f : power / full);
  sums[side] = 0.0f;
  good[side] = 0;
}

void plates_cycle(const struct measured *measured) {
  for (uint8_t side = 0; side < SIDES; ++side) {
    if (thermistor_broken(measured->part[side])) continue;
    sums[side] += thermistor_temperature(measured->part[side]);
    ++good[side];
  }
  if (++cycles < CYCLES_A_STEP) return;
  cycles = 0;
  float full = measured->supply * measured->supply / HEATER_OHMS; // W
  for (uint8_t side = 0; side < SIDES; ++side) control(side, full);
}

bool plates_set(const int16_t setpoint[SIDES]) {
  for (uint8_t side = 0; side < SIDES; ++side)
    if (setpoint[side] != MISSING16 && (setpoint[side] < 0 || setpoint[side] > HIGHEST_SETPOINT)) return false;
  for (uint8_t side = 0; side < SIDES; ++side) {
    thermostats[side].on = setpoint[side] != MISSING16;
    thermostats[side].setpoint = setpoint[side] / 100.0f;
  }
  return true;
}

bool plates_clear(uint8_t faults) {
  for (uint8_t side = 0; side < SIDES; ++side)
    if (too_hot(side)) return false;
  for (uint8_t side = 0; side < SIDES; ++side) watched[side].spent = 0.0f;
  latched &= (uint8_t)~faults;
  return true;
}

bool plates_on(void) { return thermostats[0].on || thermostats[1].on; }

void plates_off(void) {
  for (uint8_t side = 0; side < SIDES; ++side) {
    thermostats[side].on = false;
    heater_set(side, 0.0f);
  }
}

static int16_t hundredths(float value) { return (int16_t)lrintf(value * 100.0f); }

void plates_report(struct thermostat_report *report) {
  for (uint8_t side = 0; side < SIDES; ++side) {
    const struct thermostat *t = &thermostats[side];
    report->setpoint[side] = t->on ? hundredths(t->setpoint) : MISSING16;
    report->temperature[side] = plate_temperature(side);
    report->power[side] = (uint16_t)(t->power * 1000.0f + 0.5f);
  }
}

int16_t plate_temperature(uint8_t side) { return broken[side] ? MISSING16 : hundredths(thermostats[side].measured); }

bool plate_broken(uint8_t side) { return broken[side]; }

bool plate_off_setpoint(uint8_t side) {
  const struct thermostat *t = &thermostats[side];
  return t->on && !broken[side] && fabsf(t->measured - t->setpoint) > OFF_SETPOINT;
}

uint8_t plates_latched(void) { return latched; }

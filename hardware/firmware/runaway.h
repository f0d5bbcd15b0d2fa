// A heater that is on without its plate becoming warmer: a thermistor that has come off, a wire that has broken. Runs on
// any processor.
#pragma once

#include <stdbool.h>

#include "thermostat.h"

#define RUNAWAY_ENERGY 30.0f // J that must have warmed a plate
#define RUNAWAY_RISE 0.5f    // K by that much
#define OFF_SETPOINT 1.0f    // K below it that count as on its way

struct runaway {
  float coldest; // degC since it became warmer last
  float spent;   // J since then
};

// After a step of that thermostat: whether it runs away.
bool runaway_step(struct runaway *runaway, const struct thermostat *thermostat);

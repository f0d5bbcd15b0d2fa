// The law of thermal/readout/thermostat.py: PID on the measured temperature, heater limits, no windup. Runs on any processor.
#pragma once

#include <stdbool.h>

// Constants of thermal.Thermostat.
#define POWER_LIMIT 5.0f   // W
#define PROPORTIONAL 8.0f  // W/K
#define INTEGRAL 8.0f      // W/(K s)
#define DERIVATIVE 0.5f    // W s/K
#define CONTROL_STEP 0.02f // s
#define TOO_HOT 70.0f      // degC

struct thermostat {
  float setpoint;           // degC
  float measured, previous; // degC, now and a step ago
  float integral, power;    // W
  bool on;
};

// One step on a new temperature, degC; the heater's power for the next one, W. `broken`: the temperature is not known.
float thermostat_step(struct thermostat *thermostat, float measured, bool broken);

#include "thermostat.h"

float thermostat_step(struct thermostat *thermostat, float measured, bool broken) {
  struct thermostat *const t = thermostat;
  t->previous = t->measured;
  t->measured = measured;
  if (!t->on || broken) {
    t->integral = t->power = 0.0f;
    return 0.0f;
  }
  float error = t->setpoint - measured;
  float rate = (measured - t->previous) / CONTROL_STEP;
  float integral = t->integral + INTEGRAL * error * CONTROL_STEP;
  float wanted = PROPORTIONAL * error + integral - DERIVATIVE * rate;
  t->power = wanted < 0.0f ? 0.0f : wanted > POWER_LIMIT ? POWER_LIMIT : wanted;
  bool winding = (wanted - t->power) * error > 0.0f;
  if (!winding) t->integral = integral;
  return t->power;
}

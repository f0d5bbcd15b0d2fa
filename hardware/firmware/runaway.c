#include "runaway.h"

bool runaway_step(struct runaway *runaway, const struct thermostat *thermostat) {
  struct runaway *const r = runaway;
  const struct thermostat *const t = thermostat;
  bool below = t->on && t->setpoint - t->measured > OFF_SETPOINT;
  if (t->measured < r->coldest) r->coldest = t->measured;
  if (!below || t->measured >= r->coldest + RUNAWAY_RISE) {
    r->coldest = t->measured;
    r->spent = 0.0f;
  }
  r->spent += t->power * CONTROL_STEP;
  return below && r->spent >= RUNAWAY_ENERGY;
}

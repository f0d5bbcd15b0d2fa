// Both thermostats: their temperatures from the thermistors, their heaters, and what must turn those off.
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "measure.h"
#include "protocol.h"

void plates_begin(uint8_t faults); // latched from an earlier run
void plates_cycle(const struct measured *measured); // after every cycle of the converters
bool plates_set(const int16_t setpoint[SIDES]);     // 0.01 degC, MISSING16: off. False: out of range, nothing done
bool plates_clear(uint8_t faults); // these are latched no longer; false: one is too hot, nothing done
bool plates_on(void);              // one has a setpoint
void plates_off(void);             // none has
void plates_report(struct thermostat_report *report);
int16_t plate_temperature(uint8_t side); // 0.01 degC, MISSING16: not known
bool plate_broken(uint8_t side);         // its thermistor
bool plate_off_setpoint(uint8_t side);
uint8_t plates_latched(void); // why both heaters are off until plates_clear: TOO_HOT_LEFT and the like

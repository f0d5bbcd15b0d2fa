// Both thermostats: their temperatures from the thermistors, their heaters, and what must turn those off.
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "measure.h"
#include "protocol.h"

void plates_begin(void);
void plates_cycle(const struct measured *measured); // after every cycle of the converters
bool plates_set(const int16_t setpoint[SIDES]);     // 0.01 degC, MISSING16: off. False: out of range, nothing done
void plates_report(struct thermostat_report *report);
int16_t plate_temperature(uint8_t side); // 0.01 degC, MISSING16: not known
bool plate_broken(uint8_t side);         // its thermistor
bool plate_off_setpoint(uint8_t side);
bool plates_too_hot(void); // one was, since the last plates_set

// The heaters' gates on timer 1: 1 kHz, power as a part of the time.
#pragma once

#include <stdint.h>

void heaters_begin(void);
void heater_set(uint8_t side, float part); // 0 to 1

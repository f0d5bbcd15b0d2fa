// What outlives a loss of power: the number of boots, the host's calibration constants, and what is latched off.
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "protocol.h"

uint16_t memory_begin(void); // counts this boot: its number

// The stored constants, of the first of two copies that is whole, zeros where there are none. False: both are damaged.
bool memory_constants(uint8_t constants[CONSTANTS]);

// Starts storing them twice, a byte at a time: poll until it is done, 0.4 s. memory_poll is true at the end, once, and
// so it is after memory_begin has found one copy to mend by the other.
void memory_store(const uint8_t constants[CONSTANTS]);
bool memory_storing(void);
bool memory_poll(void);

// Why heaters were latched off, as stored last; and to store it, which takes effect once the EEPROM is ready.
uint8_t memory_latched(void);
void memory_latch(uint8_t faults);

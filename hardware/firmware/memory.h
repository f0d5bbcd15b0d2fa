// What outlives a loss of power: the number of boots and the host's calibration constants.
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "protocol.h"

uint16_t memory_begin(void); // counts this boot: its number

// The stored constants, zeros where there are none. False: what is stored is damaged.
bool memory_constants(uint8_t constants[CONSTANTS]);

// Starts storing them, a byte at a time: poll until it is done, 0.2 s. memory_poll is true at the end, once.
void memory_store(const uint8_t constants[CONSTANTS]);
bool memory_storing(void);
bool memory_poll(void);

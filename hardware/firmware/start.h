// What made the processor start, and whether its supply is watched.
#pragma once

#include <stdbool.h>
#include <stdint.h>

uint8_t start_cause(void); // RESET_* of protocol.h, 0: not known

// Whether the brown-out detector is set to 4.3 V, by the fuses: at 16 MHz less is not enough to run on.
bool start_guarded(void);

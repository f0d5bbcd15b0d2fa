// The time since boot.
#pragma once

#include <stdbool.h>
#include <stdint.h>

void clock_begin(void);
uint32_t clock_us(void); // modulo 2^32

// Whether a time has come, up to half an hour ago.
static inline bool reached(uint32_t us) { return (int32_t)(clock_us() - us) >= 0; }

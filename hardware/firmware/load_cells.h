// The amplified outputs of six load cells on the processor's own converter: 2.5 V without load, 25 N/V.
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "protocol.h"

void load_cells_begin(void);
void load_cells_start(void); // a round of conversions, 2.6 ms in the background
void load_cells_poll(void);

// 0.01 N of the last round, MISSING16 of a cell at an end of its range. False: there is one.
bool load_cells_read(int16_t force[SIDES][AXES]);

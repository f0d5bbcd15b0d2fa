// Both converters in turns: every 10 ms the voltages of the elements, the thermistors and the supply.
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "protocol.h"

enum { CYCLE_HZ = 100, CYCLE_US = 1000000 / CYCLE_HZ };

struct measured {
  int16_t element[SIDES]; // steps of 7.8125 uV
  bool element_known[SIDES];
  float part[SIDES]; // of the supply, at the thermistors; NAN: not known
  float supply;      // V
  uint32_t us;       // end of the last conversion
};

void measure_begin(void);

// Goes on with what is due. True once a cycle, when both sides are measured.
bool measure_poll(struct measured *measured);

#include "measure.h"

#include <math.h>

#include "ads1115.h"
#include "clock.h"
#include "load_cells.h"

#define PLATE_STEP 125.0e-6f  // V, range +-4.096 V
#define SUPPLY_STEP 187.5e-6f // V, range +-6.144 V

static uint32_t cycle, due; // when it began, when the next slot may
static uint8_t slot;

static const uint8_t element_inputs[SIDES] = {ADS_0_1, ADS_2_3};
static const uint8_t plate_inputs[SIDES] = {ADS_0, ADS_1};

static void start(uint8_t side) {
  ads1115_start(ADS_ELEMENTS, element_inputs[side], ADS_256_MV);
  ads1115_start(ADS_PLATES, plate_inputs[side], ADS_4096_MV);
  due = clock_us() + ADS_SLOT_US;
}

static void finish(struct measured *m, uint8_t side) {
  int16_t steps;
  m->element_known[side] = ads1115_read(ADS_ELEMENTS, element_inputs[side], ADS_256_MV, &m->element[side]);
  bool known = ads1115_read(ADS_PLATES, plate_inputs[side], ADS_4096_MV, &steps);
  m->part[side] = known ? (float)steps * PLATE_STEP / m->supply : NAN;
}

void measure_begin(void) {
  ads1115_begin();
  load_cells_begin();
  cycle = due = clock_us();
}

bool measure_poll(struct measured *m) {
  load_cells_poll();
  if (!reached(due)) return false;
  switch (slot++) {
  case 0:
    start(0);
    load_cells_start();
    return false;
  case 1:
    finish(m, 0);
    start(1);
    return false;
  case 2:
    m->us = due; // not when it is read
    finish(m, 1);
    ads1115_start(ADS_PLATES, ADS_3, ADS_6144_MV);
    due = clock_us() + ADS_SLOT_US;
    return true;
  default: {
    int16_t steps;
    if (ads1115_read(ADS_PLATES, ADS_3, ADS_6144_MV, &steps) && steps > 0) m->supply = (float)steps * SUPPLY_STEP;
    slot = 0;
    cycle += CYCLE_US;
    due = cycle;
    return false;
  }
  }
}

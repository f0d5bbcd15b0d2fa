#include "load_cells.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/pgmspace.h>

enum { CELLS = SIDES * AXES, REPEATS = 4, MIDDLE = 512 * REPEATS, TOP = 1023 * REPEATS };

static const uint8_t inputs[CELLS] PROGMEM = {0, 1, 2, 3, 6, 7}; // 4 and 5 are the I2C bus

static uint16_t sums[CELLS], last[CELLS];
static uint8_t done = CELLS * REPEATS; // conversions of this round

EMPTY_INTERRUPT(ADC_vect) // ends the processor's sleep

static void convert(void) {
  ADMUX = (uint8_t)(_BV(REFS0) | pgm_read_byte(&inputs[done / REPEATS]));
  ADCSRA |= _BV(ADSC);
}

void load_cells_begin(void) {
  ADCSRA = _BV(ADEN) | _BV(ADIE) | _BV(ADPS2) | _BV(ADPS1) | _BV(ADPS0); // 125 kHz
  for (uint8_t cell = 0; cell < CELLS; ++cell) last[cell] = MIDDLE;
}

void load_cells_start(void) {
  for (uint8_t cell = 0; cell < CELLS; ++cell) sums[cell] = 0;
  done = 0;
  convert();
}

void load_cells_poll(void) {
  if (done == CELLS * REPEATS || ADCSRA & _BV(ADSC)) return;
  sums[done / REPEATS] += ADC;
  if (++done < CELLS * REPEATS) {
    convert();
    return;
  }
  for (uint8_t cell = 0; cell < CELLS; ++cell) last[cell] = sums[cell];
}

bool load_cells_read(int16_t force[SIDES][AXES]) {
  bool inside = true;
  for (uint8_t cell = 0; cell < CELLS; ++cell) {
    int32_t steps = (int32_t)last[cell] - MIDDLE; // of 5 V / 1024 / REPEATS, of which each is 0.12207 N / REPEATS
    bool known = last[cell] > 0 && last[cell] < TOP;
    force[cell / AXES][cell % AXES] = known ? (int16_t)(steps * 12207 / (1000 * REPEATS)) : MISSING16;
    inside &= known;
  }
  return inside;
}

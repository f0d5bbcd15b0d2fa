#include "heaters.h"

#include <avr/io.h>

enum { TOP = 8000 };

// Phase-correct PWM, so that 0 is off without a spike. PB1 is left, PB2 right.
void heaters_begin(void) {
  ICR1 = TOP;
  OCR1A = OCR1B = 0;
  TCCR1A = _BV(COM1A1) | _BV(COM1B1) | _BV(WGM11);
  TCCR1B = _BV(WGM13) | _BV(CS10);
  DDRB |= _BV(DDB1) | _BV(DDB2);
}

void heater_set(uint8_t side, float part) {
  uint16_t count = part <= 0.0f ? 0 : part >= 1.0f ? TOP : (uint16_t)(part * TOP + 0.5f);
  if (side) {
    OCR1B = count;
  } else {
    OCR1A = count;
  }
}

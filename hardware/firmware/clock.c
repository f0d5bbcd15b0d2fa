#include "clock.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/atomic.h>

enum { TICKS_A_US = 2, TURN_US = 125 }; // timer 0 at 16 MHz / 8; a turn also ends the processor's sleep

#ifndef CLOCK_START
#define CLOCK_START 0
#endif

static volatile uint32_t whole_us = CLOCK_START; // at the timer's last turn

ISR(TIMER0_COMPA_vect) { whole_us += TURN_US; }

void clock_begin(void) {
  TCCR0A = _BV(WGM01);
  TCCR0B = _BV(CS01);
  OCR0A = TICKS_A_US * TURN_US - 1;
  TIMSK0 = _BV(OCIE0A);
}

uint32_t clock_us(void) {
  uint32_t us;
  uint8_t ticks;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    us = whole_us;
    ticks = TCNT0;
    if (TIFR0 & _BV(OCF0A)) { // it has turned since interrupts are off
      us += TURN_US;
      ticks = TCNT0;
    }
  }
  return us + ticks / TICKS_A_US;
}

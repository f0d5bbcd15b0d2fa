// Two fingertips: element voltages, thermostats and pad forces on an ATmega328P at 16 MHz. See docs/firmware.md.

#include <avr/interrupt.h>
#include <avr/sleep.h>
#include <avr/wdt.h>

#include "clock.h"
#include "device.h"
#include "measure.h"
#include "memory.h"
#include "plates.h"
#include "serial.h"

int main(void) {
  wdt_enable(WDTO_250MS);
  plates_begin(memory_latched());
  clock_begin();
  serial_begin();
  sei();
  device_begin();
  measure_begin();
  for (;;) {
    wdt_reset();
    device_poll();
    sleep_mode(); // idle until the next byte, conversion or turn of the clock
  }
}

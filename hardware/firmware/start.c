#include "start.h"

#include <avr/boot.h>
#include <avr/io.h>
#include <avr/wdt.h>
#include <util/atomic.h>

#include "protocol.h"

enum { BROWN_OUT_BITS = 0x07, BROWN_OUT_4V3 = 0x04 };

static uint8_t cause __attribute__((section(".noinit")));

// Before main, and before memory is cleared: a reset by the watchdog leaves it running, at 16 ms. A bootloader that has
// read and cleared the register (Optiboot) leaves what was in it in r2.
void start_keep_cause(void) __attribute__((naked, used, section(".init3")));
void start_keep_cause(void) {
  uint8_t loader;
  __asm__ __volatile__("mov %0, r2" : "=r"(loader));
  cause = MCUSR & RESET_ANY;
  if (cause == 0 && (loader & ~RESET_ANY) == 0) cause = loader;
  MCUSR = 0;
  wdt_disable();
}

uint8_t start_cause(void) { return cause; }

bool start_guarded(void) {
  uint8_t fuses;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { fuses = boot_lock_fuse_bits_get(GET_EXTENDED_FUSE_BITS); }
  return (fuses & BROWN_OUT_BITS) == BROWN_OUT_4V3;
}

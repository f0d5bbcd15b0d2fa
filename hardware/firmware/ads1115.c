#include "ads1115.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/twi.h>

enum { CONVERSION, CONFIGURATION }; // registers
enum { START = 0x80, // to start when written; not converting when read
       SINGLE = 0x01, RATE_475 = 0xC0, NO_COMPARATOR = 0x03 };

static volatile uint8_t bus; // status after the last step, TW_NO_INFO while it is under way

ISR(TWI_vect) {
  bus = TW_STATUS;
  TWCR = _BV(TWEN);
}

// A byte takes 23 us; a bus that is stuck must not stop the thermostats.
static uint8_t step(uint8_t control) {
  bus = TW_NO_INFO;
  TWCR = (uint8_t)(control | _BV(TWINT) | _BV(TWEN) | _BV(TWIE));
  for (uint16_t patience = 500; patience && bus == TW_NO_INFO; --patience) {}
  return bus;
}

static bool start(void) {
  uint8_t status = step(_BV(TWSTA));
  return status == TW_START || status == TW_REP_START;
}

static bool put(uint8_t byte) {
  TWDR = byte;
  uint8_t status = step(0);
  return status == TW_MT_SLA_ACK || status == TW_MT_DATA_ACK || status == TW_MR_SLA_ACK;
}

static bool get(uint8_t control, uint8_t expected, uint8_t *byte) {
  bool good = step(control) == expected;
  *byte = TWDR;
  return good;
}

static bool stop(bool good) {
  TWCR = _BV(TWINT) | _BV(TWEN) | _BV(TWSTO);
  for (uint16_t patience = 400; (TWCR & _BV(TWSTO)) && patience; --patience) {}
  if (!good) TWCR = 0; // lets go of the bus
  return good;
}

void ads1115_begin(void) {
  TWSR = 0;
  TWBR = 12; // 16 MHz / (16 + 2 x 12) = 400 kHz
}

static uint16_t configuration(uint8_t inputs, uint8_t range) {
  return (uint16_t)((START | inputs << 4 | range << 1 | SINGLE) << 8 | RATE_475 | NO_COMPARATOR);
}

static bool read_register(uint8_t address, uint8_t which, uint16_t *value) {
  uint8_t high = 0, low = 0;
  bool good = start() && put((uint8_t)(address << 1 | TW_WRITE)) && put(which) && start() &&
              put((uint8_t)(address << 1 | TW_READ)) && get(_BV(TWEA), TW_MR_DATA_ACK, &high) &&
              get(0, TW_MR_DATA_NACK, &low);
  *value = (uint16_t)(high << 8 | low);
  return stop(good);
}

bool ads1115_start(uint8_t address, uint8_t inputs, uint8_t range) {
  uint16_t wanted = configuration(inputs, range);
  return stop(start() && put((uint8_t)(address << 1 | TW_WRITE)) && put(CONFIGURATION) && put((uint8_t)(wanted >> 8)) &&
              put((uint8_t)wanted));
}

bool ads1115_read(uint8_t address, uint8_t inputs, uint8_t range, int16_t *steps) {
  uint16_t is, value;
  if (!read_register(address, CONFIGURATION, &is) || is != configuration(inputs, range)) return false;
  if (!read_register(address, CONVERSION, &value)) return false;
  *steps = (int16_t)value;
  return true;
}

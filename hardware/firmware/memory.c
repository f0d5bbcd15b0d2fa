#include "memory.h"

#include <avr/eeprom.h>
#include <string.h>

#include "frame.h"

// Two copies, one after the other, so that of a write that is cut off one is whole.
enum { BOOTS = 0, STORED = 2, SIZE = CONSTANTS + FRAME_CRC, COPIES = 2, BLANK = 0xFF };
enum { LATCHED = STORED + COPIES * SIZE };
enum found { NOTHING, DAMAGED, WHOLE };

static uint8_t image[SIZE];
static uint8_t next = COPIES * SIZE; // byte to write

static uint8_t *place(uint8_t address) { return (uint8_t *)(uintptr_t)address; }

static enum found load(uint8_t copy, uint8_t found[SIZE]) {
  bool blank = true;
  eeprom_read_block(found, place((uint8_t)(STORED + copy * SIZE)), SIZE);
  for (uint8_t i = 0; i < SIZE; ++i) blank &= found[i] == BLANK;
  uint32_t crc = crc32(found, CONSTANTS);
  return memcmp(&crc, found + CONSTANTS, FRAME_CRC) == 0 ? WHOLE : blank ? NOTHING : DAMAGED;
}

static void count_boot(uint16_t *boots) {
  uint16_t *address = (uint16_t *)(uintptr_t)BOOTS;
  *boots = eeprom_read_word(address);
  *boots = *boots == UINT16_MAX ? 1 : (uint16_t)(*boots + 1); // blank
  eeprom_update_word(address, *boots);
}

uint16_t memory_begin(void) {
  uint16_t boots;
  uint8_t second[SIZE];
  count_boot(&boots);
  enum found first = load(0, image), other = load(1, second);
  if (first != WHOLE && other == WHOLE) memcpy(image, second, SIZE);
  bool whole = first == WHOLE || other == WHOLE;
  if (whole && (first != other || memcmp(image, second, SIZE) != 0)) next = 0; // mends the other one
  return boots;
}

bool memory_constants(uint8_t constants[CONSTANTS]) {
  uint8_t found[SIZE];
  bool damaged = false;
  for (uint8_t copy = 0; copy < COPIES; ++copy) {
    enum found is = load(copy, found);
    if (is == WHOLE) {
      memcpy(constants, found, CONSTANTS);
      return true;
    }
    damaged |= is == DAMAGED;
  }
  memset(constants, 0, CONSTANTS);
  return !damaged;
}

void memory_store(const uint8_t constants[CONSTANTS]) {
  memcpy(image, constants, CONSTANTS);
  uint32_t crc = crc32(image, CONSTANTS);
  memcpy(image + CONSTANTS, &crc, FRAME_CRC);
  next = 0;
}

uint8_t memory_latched(void) {
  uint8_t found = eeprom_read_byte(place(LATCHED));
  return found == BLANK ? 0 : found;
}

void memory_latch(uint8_t faults) {
  if (eeprom_is_ready()) eeprom_update_byte(place(LATCHED), faults);
}

bool memory_storing(void) { return next < COPIES * SIZE; }

bool memory_poll(void) {
  if (!memory_storing() || !eeprom_is_ready()) return false;
  eeprom_update_byte(place((uint8_t)(STORED + next)), image[next % SIZE]);
  return ++next == COPIES * SIZE;
}

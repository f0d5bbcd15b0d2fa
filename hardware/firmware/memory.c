#include "memory.h"

#include <avr/eeprom.h>
#include <string.h>

#include "frame.h"

enum { BOOTS = 0, STORED = 2, SIZE = CONSTANTS + FRAME_CRC, BLANK = 0xFF };

static uint8_t image[SIZE];
static uint8_t next = SIZE; // byte to write

static uint8_t *place(uint8_t address) { return (uint8_t *)(uintptr_t)address; }

uint16_t memory_begin(void) {
  uint16_t *address = (uint16_t *)(uintptr_t)BOOTS;
  uint16_t boots = eeprom_read_word(address);
  boots = boots == UINT16_MAX ? 1 : (uint16_t)(boots + 1); // blank
  eeprom_update_word(address, boots);
  return boots;
}

bool memory_constants(uint8_t constants[CONSTANTS]) {
  uint8_t found[SIZE];
  bool blank = true;
  eeprom_read_block(found, place(STORED), SIZE);
  for (uint8_t i = 0; i < SIZE; ++i) blank &= found[i] == BLANK;
  uint32_t crc = crc32(found, CONSTANTS);
  bool good = memcmp(&crc, found + CONSTANTS, FRAME_CRC) == 0;
  memset(constants, 0, CONSTANTS);
  if (good) memcpy(constants, found, CONSTANTS);
  return good || blank;
}

void memory_store(const uint8_t constants[CONSTANTS]) {
  memcpy(image, constants, CONSTANTS);
  uint32_t crc = crc32(image, CONSTANTS);
  memcpy(image + CONSTANTS, &crc, FRAME_CRC);
  next = 0;
}

bool memory_storing(void) { return next < SIZE; }

bool memory_poll(void) {
  if (!memory_storing() || !eeprom_is_ready()) return false;
  eeprom_update_byte(place((uint8_t)(STORED + next)), image[next]);
  return ++next == SIZE;
}

// Frames between zeros: COBS and CRC-32. Runs on any processor.
#pragma once

#include <stdbool.h>
#include <stdint.h>

enum { FRAME_LONGEST = 64, FRAME_CRC = 4, FRAME_SHORTEST = 12 };

uint32_t crc32(const uint8_t *data, uint8_t length);

// Stuffs `length` bytes, at most FRAME_LONGEST, into length + 1 without a zero.
void cobs_encode(const uint8_t *block, uint8_t length, uint8_t *stuffed);

// Unstuffs in place; the length of the block, 0 where it is none.
uint8_t cobs_decode(uint8_t *stuffed, uint8_t length);

struct receiver {
  uint8_t bytes[FRAME_LONGEST + 1];
  uint8_t length;
  bool overlong;
  uint16_t bad; // chunks that were no frame
};

// The length, without its checksum, of the frame that this byte ends, 0 where it ends none. It lies in `bytes`.
uint8_t receive(struct receiver *receiver, uint8_t byte);

#include "frame.h"

#include <string.h>

#ifdef __AVR__
#include <avr/pgmspace.h>
#else
#define PROGMEM
#define pgm_read_dword(address) (*(address))
#endif

// CRC-32 of zlib, four bits at a time: a table of 64 bytes and 6 us a byte at 16 MHz.
static const uint32_t nibbles[16] PROGMEM = {
    0x00000000, 0x1DB71064, 0x3B6E20C8, 0x26D930AC, 0x76DC4190, 0x6B6B51F4, 0x4DB26158, 0x5005713C,
    0xEDB88320, 0xF00F9344, 0xD6D6A3E8, 0xCB61B38C, 0x9B64C2B0, 0x86D3D2D4, 0xA00AE278, 0xBDBDF21C,
};

uint32_t crc32(const uint8_t *data, uint8_t length) {
  uint32_t crc = 0xFFFFFFFF;
  while (length--) {
    crc ^= *data++;
    crc = (crc >> 4) ^ pgm_read_dword(&nibbles[crc & 0x0F]);
    crc = (crc >> 4) ^ pgm_read_dword(&nibbles[crc & 0x0F]);
  }
  return ~crc;
}

void cobs_encode(const uint8_t *block, uint8_t length, uint8_t *stuffed) {
  uint8_t *distance = stuffed++;
  *distance = 1;
  while (length--) {
    if (*block) {
      *stuffed = *block;
      ++*distance;
    } else {
      distance = stuffed;
      *distance = 1;
    }
    ++block;
    ++stuffed;
  }
}

uint8_t cobs_decode(uint8_t *stuffed, uint8_t length) {
  uint8_t next = 0; // place of the next distance
  for (uint8_t place = 0; place < length; ++place) {
    if (stuffed[place] == 0) return 0;
    if (place == next) {
      if (stuffed[place] > length - place) return 0;
      next = (uint8_t)(place + stuffed[place]);
      if (place) stuffed[place - 1] = 0;
    } else {
      stuffed[place - 1] = stuffed[place];
    }
  }
  return length ? (uint8_t)(length - 1) : 0;
}

uint8_t receive(struct receiver *receiver, uint8_t byte) {
  if (byte) {
    if (receiver->length == sizeof receiver->bytes) {
      receiver->overlong = true;
    } else {
      receiver->bytes[receiver->length++] = byte;
    }
    return 0;
  }
  uint8_t length = receiver->length;
  bool overlong = receiver->overlong;
  receiver->length = 0;
  receiver->overlong = false;
  if (length == 0) return 0;
  length = overlong ? 0 : cobs_decode(receiver->bytes, length);
  if (length >= FRAME_SHORTEST) {
    uint8_t body = (uint8_t)(length - FRAME_CRC);
    uint32_t crc = crc32(receiver->bytes, body);
    if (memcmp(&crc, receiver->bytes + body, FRAME_CRC) == 0) return body;
  }
  ++receiver->bad;
  return 0;
}

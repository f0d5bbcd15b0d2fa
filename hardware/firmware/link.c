#include "link.h"

#include <stddef.h>
#include <string.h>

#include "frame.h"
#include "serial.h"

#ifndef SEQUENCE_START
#define SEQUENCE_START 0
#endif

static uint16_t sequence = SEQUENCE_START;
static struct receiver receiver;

bool link_send(uint8_t code, uint8_t flags, const void *payload, uint8_t length, uint32_t us) {
  uint8_t block[FRAME_LONGEST], stuffed[FRAME_LONGEST + 1];
  struct header header = {.code = code, .flags = flags, .sequence = sequence, .device_us = us};
  uint8_t size = (uint8_t)(sizeof header + length);
  if (serial_room() < size + FRAME_CRC + 3) return false;
  memcpy(block, &header, sizeof header);
  memcpy(block + sizeof header, payload, length);
  uint32_t crc = crc32(block, size);
  memcpy(block + size, &crc, FRAME_CRC);
  size += FRAME_CRC;
  cobs_encode(block, size, stuffed);
  serial_put(0);
  for (uint8_t i = 0; i <= size; ++i) serial_put(stuffed[i]);
  serial_put(0);
  ++sequence;
  return true;
}

static uint8_t payload_length(uint8_t code) { // 0: not a command
  switch (code) {
  case IDENTIFY:
  case SET_SETPOINT:
    return 4;
  case REQUEST:
  case CLEAR_FAULTS:
    return 1;
  case SET_RATE:
  case RUN_SELF_TEST:
  case KEEP_ALIVE:
    return 2;
  case SET_CALIBRATION:
    return CONSTANTS;
  default:
    return 0;
  }
}

const uint8_t *link_receive(struct header *command) {
  uint8_t byte;
  while (serial_take(&byte)) {
    uint8_t length = receive(&receiver, byte);
    if (length == 0) continue;
    memcpy(command, receiver.bytes, sizeof *command);
    uint8_t payload = payload_length(command->code);
    if (payload && length == sizeof *command + payload) return receiver.bytes + sizeof *command;
    ++receiver.bad;
  }
  return NULL;
}

uint16_t link_bad_frames(void) { return receiver.bad; }

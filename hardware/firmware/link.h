// Frames to and from the host.
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "protocol.h"

// Sends a frame, numbered, whole or, where it finds no room, not at all.
bool link_send(uint8_t code, uint8_t flags, const void *payload, uint8_t length, uint32_t us);

// The payload of the next command that has come, NULL where there is none. It stays until the next call.
const uint8_t *link_receive(struct header *command);

uint16_t link_bad_frames(void);

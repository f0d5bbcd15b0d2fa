// The line to the host: 500000 baud, 8N1, buffered both ways.
#pragma once

#include <stdbool.h>
#include <stdint.h>

void serial_begin(void);
bool serial_take(uint8_t *byte); // whether there was one
uint8_t serial_room(void);       // bytes that serial_put takes without loss
void serial_put(uint8_t byte);

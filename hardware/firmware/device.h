// A device of docs/protocol.md: what it measures, holds and answers.
#pragma once

void device_begin(void);
void device_poll(void);

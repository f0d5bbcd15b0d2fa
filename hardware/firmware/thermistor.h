// A thermistor of 10 kohm (B25/85 = 3977 K) to ground under 10 kohm to the supply. Runs on any processor.
#pragma once

#include <stdbool.h>

// degC of the divider's voltage as a part of the supply's.
float thermistor_temperature(float part);

// Whether that part can't be one of a thermistor: a broken wire, a short circuit.
bool thermistor_broken(float part);

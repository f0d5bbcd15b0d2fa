#include "thermistor.h"

#include <math.h>

#define BETA 3977.0f          // K (Vishay NTCLE100E3103, B25/85)
#define RESISTANCE_RATIO 1.0f // 10 kohm at 25 degC over the divider's 10 kohm
#define ZERO 273.15f          // K

float thermistor_temperature(float part) {
  float resistance = part / (1.0f - part) / RESISTANCE_RATIO; // of that at 25 degC
  return 1.0f / (1.0f / (ZERO + 25.0f) + logf(resistance) / BETA) - ZERO;
}

// 0.02 is 148 degC; 0.8 is -3 degC, close to where the converter's range ends at a supply of 5.12 V.
bool thermistor_broken(float part) { return !(part > 0.02f && part < 0.8f); }

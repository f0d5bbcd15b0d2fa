// ADS1115 converters on I2C at 400 kHz (TI SBAS444).
#pragma once

#include <stdbool.h>
#include <stdint.h>

enum { ADS_ELEMENTS = 0x48, ADS_PLATES = 0x49 };          // addresses: ADDR to ground, to the supply
enum { ADS_SLOT_US = 2400 };                              // a conversion at 475 a second, 10 % slow, and its wake-up
enum { ADS_0_1 = 0x0, ADS_2_3 = 0x3, ADS_0 = 0x4, ADS_1 = 0x5, ADS_3 = 0x7 }; // inputs
enum { ADS_6144_MV = 0x0, ADS_4096_MV = 0x1, ADS_256_MV = 0x5 };              // ranges: +- that

void ads1115_begin(void);
bool ads1115_start(uint8_t address, uint8_t inputs, uint8_t range); // false: nobody answers

// The result of that conversion. False where there is none: nobody answers, it is not finished, or the converter has
// lost its supply meanwhile. A heater must not follow the result of another conversion.
bool ads1115_read(uint8_t address, uint8_t inputs, uint8_t range, int16_t *steps);

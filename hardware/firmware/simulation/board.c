// The board around the processor, for simavr: two ADS1115, six load cells, and two plates that the heaters warm.
//
// A library that runs in simulated time only: whoever calls it says until when, and gives and takes the bytes of the
// line. The same calls give the same bits.

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <avr_adc.h>
#include <avr_eeprom.h>
#include <avr_twi.h>
#include <avr_uart.h>
#include <sim_avr.h>
#include <sim_elf.h>

enum { FREQUENCY = 16000000, BYTE_CYCLES = FREQUENCY / 500000 * 10, PLANT_CYCLES = FREQUENCY / 1000 };
enum { SIDES = 2, CELLS = 6, LINE = 1 << 20 };
enum { OCR1A_ = 0x88, ICR1_ = 0x86, MCUSR_ = 0x54, SPMCSR_ = 0x57 }; // in its memory; OCR1B follows OCR1A
enum { POWER_ON = 0x01, READ_FUSES = 0x09, EXTENDED_FUSES = 2 };       // RFLB and SELFPRGEN; where LPM reads them

// What a caller may read and write at any time; SI units and degC.
struct signals {
  double voltage[SIDES];     // at the elements
  double force[CELLS];       // N, left normal and tangential, then right
  double heat[SIDES];        // W drawn from the plates
  double ambient, supply;    // degC, V
  double heat_capacity;      // J/K of a plate
  double loss, lag;          // W/K to the air, s of the thermistor
  double noise;              // steps rms of the ADS1115
  double conversion;         // s that it takes
  double plate[SIDES];       // degC
  double thermistor[SIDES];  // degC
  double power[SIDES];       // W of the heaters
  int32_t open[SIDES];       // a thermistor's wire is broken
  int32_t deaf[SIDES];       // the converters of the elements and of the plates do not answer
  int32_t loose[SIDES];      // a thermistor has come off its plate
  int32_t cold[SIDES];       // a heater's wire is broken
  int32_t fuses;             // the extended byte
};

struct converter {
  uint8_t address, pointer, index, selected;
  uint16_t configuration;
  int16_t result;
  avr_cycle_count_t ready;
};

struct board {
  struct signals signals;
  avr_t *avr;
  avr_irq_t *twi_in, *uart_in, *cells[CELLS];
  struct converter converters[SIDES];
  uint32_t random;
  uint8_t to_board[LINE], from_board[LINE];
  uint32_t given, taken, said, heard;
  avr_cycle_count_t next_byte, before; // before: cycles until the last reset
};

struct board *board_new(const char *elf);
void board_free(struct board *board);
void board_reset(struct board *board, int cause);
int board_run(struct board *board, double until);
double board_time(const struct board *board);
void board_give(struct board *board, const uint8_t *bytes, uint32_t count);
uint32_t board_take(struct board *board, uint8_t *bytes, uint32_t room);
uint8_t board_memory(const struct board *board, uint16_t address);
uint8_t board_stored(struct board *board, uint16_t address);
void board_store(struct board *board, uint16_t address, uint8_t value);

static double normal(struct board *board) { // by the central limit, of 12 uniform numbers
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) {
    board->random ^= board->random << 13;
    board->random ^= board->random >> 17;
    board->random ^= board->random << 5;
    sum += board->random / 4294967296.0;
  }
  return sum;
}

static double divider(const struct signals *s, int side) { // V of the thermistor under 10 kohm
  if (s->open[side]) return s->supply;
  double ratio = exp(3977.0 * (1.0 / (273.15 + s->thermistor[side]) - 1.0 / 298.15));
  return s->supply * ratio / (1.0 + ratio);
}

static int16_t convert(struct board *board, const struct converter *c) {
  static const double spans[8] = {6.144, 4.096, 2.048, 1.024, 0.512, 0.256, 0.256, 0.256};
  const struct signals *s = &board->signals;
  int inputs = c->configuration >> 12 & 7;
  double volts = 0.0;
  if (c == board->converters) {
    volts = inputs == 0 ? s->voltage[0] : inputs == 3 ? s->voltage[1] : 0.0;
  } else {
    volts = inputs == 4 ? divider(s, 0) : inputs == 5 ? divider(s, 1) : inputs == 7 ? s->supply : 0.0;
  }
  double steps = rint(volts / (spans[c->configuration >> 9 & 7] / 32768.0) + s->noise * normal(board));
  return (int16_t)fmax(-32768.0, fmin(32767.0, steps));
}

static void take_byte(struct board *board, struct converter *c, uint8_t byte) {
  if (c->index == 0) {
    c->pointer = byte;
  } else if (c->pointer == 1) {
    c->configuration = (uint16_t)(c->index == 1 ? byte << 8 : (c->configuration & 0xFF00) | byte);
    if (c->index == 2 && c->configuration & 0x8000)
      c->ready = board->avr->cycle + (avr_cycle_count_t)(board->signals.conversion * FREQUENCY);
  }
  ++c->index;
}

static uint8_t give_byte(struct board *board, struct converter *c) {
  if (c->index == 0 && c->ready && board->avr->cycle >= c->ready) {
    c->result = convert(board, c);
    c->ready = 0;
  }
  uint16_t status = (uint16_t)((c->configuration & 0x7FFF) | (c->ready ? 0 : 0x8000));
  uint16_t value = c->pointer == 1 ? status : (uint16_t)c->result;
  return (uint8_t)(c->index++ ? value : value >> 8);
}

static void on_twi(struct avr_irq_t *irq, uint32_t value, void *param) {
  (void)irq;
  struct board *board = param;
  avr_twi_msg_irq_t message = {.u.v = value};
  uint8_t what = message.u.twi.msg;
  for (int i = 0; i < SIDES; ++i) {
    struct converter *c = &board->converters[i];
    if (what & (TWI_COND_STOP | TWI_COND_START)) c->selected = 0;
    if (what & TWI_COND_START && message.u.twi.addr >> 1 == c->address && !board->signals.deaf[i]) {
      c->selected = message.u.twi.addr;
      c->index = 0;
      avr_raise_irq(board->twi_in, avr_twi_irq_msg(TWI_COND_ACK, c->selected, 1));
    }
    if (!c->selected) continue;
    if (what & TWI_COND_WRITE) {
      avr_raise_irq(board->twi_in, avr_twi_irq_msg(TWI_COND_ACK, c->selected, 1));
      take_byte(board, c, message.u.twi.data);
    }
    if (what & TWI_COND_READ)
      avr_raise_irq(board->twi_in, avr_twi_irq_msg(TWI_COND_READ, c->selected, give_byte(board, c)));
  }
}

static void on_byte(struct avr_irq_t *irq, uint32_t value, void *param) {
  (void)irq;
  struct board *board = param;
  board->from_board[board->said++ % LINE] = (uint8_t)value;
}

static uint16_t word(const struct board *board, int address) {
  return (uint16_t)(board->avr->data[address] | board->avr->data[address + 1] << 8);
}

// A millisecond of plates, thermistors and load cells.
static avr_cycle_count_t plant(avr_t *avr, avr_cycle_count_t when, void *param) {
  (void)avr;
  struct board *board = param;
  struct signals *s = &board->signals;
  double dt = (double)PLANT_CYCLES / FREQUENCY, top = fmax(1.0, word(board, ICR1_));
  for (int side = 0; side < SIDES; ++side) {
    double driven = s->supply * s->supply / 5.0 * fmin(1.0, word(board, OCR1A_ + 2 * side) / top);
    s->power[side] = s->cold[side] ? 0.0 : driven;
    double gain = s->power[side] - s->heat[side] - s->loss * (s->plate[side] - s->ambient);
    s->plate[side] += dt * gain / s->heat_capacity;
    double around = s->loose[side] ? s->ambient : s->plate[side];
    s->thermistor[side] += (around - s->thermistor[side]) * (1.0 - exp(-dt / s->lag));
  }
  for (int i = 0; i < CELLS; ++i) // simavr takes whole mV: noise keeps what lies between
    avr_raise_irq(board->cells[i],
                  (uint32_t)fmax(0.0, fmin(5000.0, rint(2500.0 + 40.0 * s->force[i] + 2.0 * normal(board)))));
  return when + PLANT_CYCLES;
}

static void quiet(avr_t *avr, const int level, const char *format, va_list arguments) {
  (void)avr, (void)level, (void)format, (void)arguments;
}

static void no_pause(avr_t *avr, avr_cycle_count_t cycles) { (void)avr, (void)cycles; } // a sleep takes simulated time

struct board *board_new(const char *elf) {
  static const int pins[CELLS] = {0, 1, 2, 3, 6, 7};
  elf_firmware_t firmware;
  memset(&firmware, 0, sizeof firmware);
  avr_global_logger_set(quiet);
  if (elf_read_firmware(elf, &firmware) != 0) return NULL;
  struct board *board = calloc(1, sizeof *board);
  avr_t *avr = avr_make_mcu_by_name("atmega328p");
  if (!board || !avr) return NULL;
  board->avr = avr;
  board->random = 2463534242;
  board->converters[0].address = 0x48;
  board->converters[1].address = 0x49;
  board->signals = (struct signals){.ambient = 24.0,
                                    .supply = 5.0,
                                    .heat_capacity = 1.6856,
                                    .loss = 0.008,
                                    .lag = 0.2,
                                    .noise = 1.0,
                                    .conversion = 1.0 / 475.0,
                                    .fuses = 0xFC, // brown-out at 4.3 V
                                    .plate = {24.0, 24.0},
                                    .thermistor = {24.0, 24.0}};
  avr_init(avr);
  avr->frequency = FREQUENCY;
  avr->sleep = no_pause;
  avr->vcc = avr->avcc = avr->aref = 5000;
  avr_load_firmware(avr, &firmware);
  avr->data[MCUSR_] = POWER_ON;
  board->twi_in = avr_io_getirq(avr, AVR_IOCTL_TWI_GETIRQ(0), TWI_IRQ_INPUT);
  avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_TWI_GETIRQ(0), TWI_IRQ_OUTPUT), on_twi, board);
  uint32_t flags = 0;
  avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
  board->uart_in = avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
  avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), on_byte, board);
  for (int i = 0; i < CELLS; ++i) board->cells[i] = avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC0 + pins[i]);
  avr_cycle_timer_register(avr, PLANT_CYCLES, plant, board);
  return board;
}

void board_free(struct board *board) {
  avr_terminate(board->avr);
  free(board->avr);
  free(board);
}

// cause: what MCUSR says of it; of a loss of power the EEPROM is all that stays.
void board_reset(struct board *board, int cause) {
  board->before += board->avr->cycle;
  avr_reset(board->avr);
  board->before -= board->avr->cycle; // 0 in some versions
  board->avr->data[MCUSR_] = (uint8_t)cause;
  board->taken = board->given;
  board->next_byte = board->converters[0].ready = board->converters[1].ready = 0;
  avr_cycle_timer_register(board->avr, PLANT_CYCLES, plant, board);
}

// Runs until that time, s; 0 when it could.
int board_run(struct board *board, double until) {
  avr_t *avr = board->avr;
  avr_cycle_count_t end = (avr_cycle_count_t)(until * FREQUENCY + 0.5);
  while (board->before + avr->cycle < end) {
    if (board->taken != board->given && avr->cycle >= board->next_byte) {
      avr_raise_irq(board->uart_in, board->to_board[board->taken++ % LINE]);
      board->next_byte = avr->cycle + BYTE_CYCLES;
    }
    uint8_t code = avr->flash[EXTENDED_FUSES]; // simavr reads the program where fuses were asked for
    if ((avr->data[SPMCSR_] & READ_FUSES) == READ_FUSES) avr->flash[EXTENDED_FUSES] = (uint8_t)board->signals.fuses;
    int state = avr_run(avr);
    avr->flash[EXTENDED_FUSES] = code;
    if (state == cpu_Done || state == cpu_Crashed) return 1;
  }
  return 0;
}

double board_time(const struct board *board) { return (double)(board->before + board->avr->cycle) / FREQUENCY; }

void board_give(struct board *board, const uint8_t *bytes, uint32_t count) {
  while (count--) board->to_board[board->given++ % LINE] = *bytes++;
}

uint32_t board_take(struct board *board, uint8_t *bytes, uint32_t room) {
  uint32_t count = 0;
  while (count < room && board->heard != board->said) bytes[count++] = board->from_board[board->heard++ % LINE];
  return count;
}

uint8_t board_memory(const struct board *board, uint16_t address) { return board->avr->data[address]; }

uint8_t board_stored(struct board *board, uint16_t address) {
  avr_eeprom_desc_t all = {.ee = NULL, .offset = 0, .size = 0};
  avr_ioctl(board->avr, AVR_IOCTL_EEPROM_GET, &all);
  return all.ee[address];
}

void board_store(struct board *board, uint16_t address, uint8_t value) {
  avr_eeprom_desc_t byte = {.ee = &value, .offset = address, .size = 1};
  avr_ioctl(board->avr, AVR_IOCTL_EEPROM_SET, &byte);
}

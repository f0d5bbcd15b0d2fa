#include "serial.h"

#include <avr/interrupt.h>
#include <avr/io.h>

static struct {
  volatile uint8_t bytes[256];
  volatile uint8_t head, tail; // of a ring that is empty where they are equal
} in, out;

ISR(USART_RX_vect) {
  uint8_t byte = UDR0;
  uint8_t next = (uint8_t)(in.head + 1);
  if (next != in.tail) { // else it is lost, and the frame's checksum tells
    in.bytes[in.head] = byte;
    in.head = next;
  }
}

ISR(USART_UDRE_vect) { // may come once more after the last byte, between the two steps of serial_put
  if (out.tail == out.head) {
    UCSR0B &= (uint8_t)~_BV(UDRIE0);
    return;
  }
  UDR0 = out.bytes[out.tail];
  ++out.tail;
}

void serial_begin(void) {
  UBRR0 = 1; // 16 MHz / 16 / 2, exactly
  UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
  UCSR0B = _BV(RXCIE0) | _BV(RXEN0) | _BV(TXEN0);
}

bool serial_take(uint8_t *byte) {
  if (in.tail == in.head) return false;
  *byte = in.bytes[in.tail];
  ++in.tail;
  return true;
}

uint8_t serial_room(void) { return (uint8_t)(out.tail - out.head - 1); }

void serial_put(uint8_t byte) {
  out.bytes[out.head] = byte;
  ++out.head;
  UCSR0B |= _BV(UDRIE0);
}

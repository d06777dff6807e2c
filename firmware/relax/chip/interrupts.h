/* What the interrupts share with the board: lamp and samples, pulses of the wheels, edges of the encoders, the serial line.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef INTERRUPTS_H
#define INTERRUPTS_H

#include "stc90.h"
#include <stdint.h>

/* Bytes of the rings, powers of two. */
#define RECEIVE_RING 64
#define SEND_RING 16

/* Ports with the lamp on and off; bit 0 of lit_p1 and bit 2 of lit_p2 gather over a millisecond. */
extern volatile __data uint8_t lit_p0, dark_p0;
extern volatile __data uint8_t pressed;
#define PRESSED_LEFT 1
#define PRESSED_RIGHT 2
/* Milliseconds and edges, wrapping. */
extern volatile __data uint8_t milliseconds;
extern volatile __data uint8_t edges_left, edges_right;
/* Strength of a wheel's pulses, 0..255, and whether it goes backward. */
extern volatile __data uint8_t strength_left, strength_right;
extern volatile __bit backward_left, backward_right;
/* The serial line. */
extern volatile __data uint8_t received_to, received_from, sent_to, sent_from;
extern volatile __bit line_error, line_overrun, is_sending;
extern __xdata uint8_t receive_ring[RECEIVE_RING];
extern __xdata uint8_t send_ring[SEND_RING];

void interrupts_start(void);
void on_pulse(void) __interrupt(TF0_VECTOR) __using(1);
void on_lit(void) __interrupt(TF1_VECTOR) __using(1);
void on_serial(void) __interrupt(SI0_VECTOR) __using(1);

#endif

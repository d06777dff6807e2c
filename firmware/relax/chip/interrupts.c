/* Three interrupts. They call nothing, and so share no registers or arguments with the main loop.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "interrupts.h"
#include "pins.h"

/* 2 kHz: every 2,500 cycles; the timer stands still for seven of them while it is set. */
#define PULSE_RELOAD (65536UL - 2500 + 7)
/* The lamp is on for 100 us, a fifth of the time, before the sensors are read. */
#define LIT_RELOAD (65536UL - 430)
/* Odd, so that all 256 phases come, and the golden section of 256, so that those below a strength come evenly. */
#define PHASE_STEP 159
#define ENCODERS (ENCODER_LEFT_MASK | ENCODER_RIGHT_MASK)

volatile __data uint8_t lit_p0, dark_p0;
volatile __data uint8_t pressed;
volatile __data uint8_t milliseconds;
volatile __data uint8_t edges_left, edges_right;
volatile __data uint8_t strength_left, strength_right;
volatile __bit backward_left, backward_right;
volatile __data uint8_t received_to, received_from, sent_to, sent_from;
volatile __bit line_error, line_overrun, is_sending;
__xdata uint8_t receive_ring[RECEIVE_RING];
__xdata uint8_t send_ring[SEND_RING];

/* Where in its 256 pulses a wheel's strength is, and the encoders' last levels. */
static __data uint8_t phase;
static __data uint8_t encoder_levels;
static __bit is_half;

void interrupts_start(void) {
    lit_p0 = dark_p0 = pressed = 0;
    milliseconds = edges_left = edges_right = 0;
    strength_left = strength_right = phase = 0;
    received_to = received_from = sent_to = sent_from = 0;
    line_error = line_overrun = is_sending = is_half = 0;
    encoder_levels = P0 & ENCODERS;
    TMOD = 0x11;
    TH0 = PULSE_RELOAD >> 8;
    TL0 = (uint8_t)PULSE_RELOAD;
    SCON = SCON_MODE_1;
    PCON |= PCON_SMOD0;
    RCAP2H = RCAP2_38400 >> 8;
    RCAP2L = (uint8_t)RCAP2_38400;
    T2CON = T2CON_BAUD;
    TR0 = 1;
    ET0 = 1;
    ET1 = 1;
    ES = 1;
    EA = 1;
}

/* Every half millisecond: the lamp goes on, wheels get their pulse, encoders are looked at. */
void on_pulse(void) __interrupt(TF0_VECTOR) __using(1) {
    uint8_t now;
    TR0 = 0;
    __asm
        mov a, _TL0
        add a, #(65536 - 2500 + 7)
        mov _TL0, a
        mov a, _TH0
        addc a, #((65536 - 2500 + 7) >> 8)
        mov _TH0, a
    __endasm;
    TR0 = 1;
    now = P0;
    dark_p0 = now;
    SENSOR_LIGHT = SENSOR_LIGHT_ACTIVE;
    TH1 = LIT_RELOAD >> 8;
    TL1 = (uint8_t)LIT_RELOAD;
    TR1 = 1;
    is_half = !is_half;
    if (is_half) {
        milliseconds++;
    }
    now &= ENCODERS;
    if (now != encoder_levels) {
        encoder_levels ^= now;
        if (encoder_levels & ENCODER_LEFT_MASK) {
            edges_left++;
        }
        if (encoder_levels & ENCODER_RIGHT_MASK) {
            edges_right++;
        }
        encoder_levels = now;
    }
    /* A pulse while the phase is below the strength: the weaker wheel has none without the stronger one, so that a turn on the spot
     * beside an obstacle never pushes ahead. The two lines of a wheel are never on together. */
    phase += PHASE_STEP;
    if (phase < strength_left) {
        if (backward_left) {
            WHEEL_LEFT_FORWARD = !WHEEL_LEFT_FORWARD_ACTIVE;
            WHEEL_LEFT_BACKWARD = WHEEL_LEFT_BACKWARD_ACTIVE;
        } else {
            WHEEL_LEFT_BACKWARD = !WHEEL_LEFT_BACKWARD_ACTIVE;
            WHEEL_LEFT_FORWARD = WHEEL_LEFT_FORWARD_ACTIVE;
        }
    } else {
        WHEEL_LEFT_FORWARD = !WHEEL_LEFT_FORWARD_ACTIVE;
        WHEEL_LEFT_BACKWARD = !WHEEL_LEFT_BACKWARD_ACTIVE;
    }
    if (phase < strength_right) {
        if (backward_right) {
            WHEEL_RIGHT_FORWARD = !WHEEL_RIGHT_FORWARD_ACTIVE;
            WHEEL_RIGHT_BACKWARD = WHEEL_RIGHT_BACKWARD_ACTIVE;
        } else {
            WHEEL_RIGHT_BACKWARD = !WHEEL_RIGHT_BACKWARD_ACTIVE;
            WHEEL_RIGHT_FORWARD = WHEEL_RIGHT_FORWARD_ACTIVE;
        }
    } else {
        WHEEL_RIGHT_FORWARD = !WHEEL_RIGHT_FORWARD_ACTIVE;
        WHEEL_RIGHT_BACKWARD = !WHEEL_RIGHT_BACKWARD_ACTIVE;
    }
}

/* A tenth of a millisecond later: sensors are read by their light, and the lamp goes off. */
void on_lit(void) __interrupt(TF1_VECTOR) __using(1) {
    TR1 = 0;
    lit_p0 = P0;
    if (BUMPER_LEFT == BUMPER_LEFT_ACTIVE) {
        pressed |= PRESSED_LEFT;
    }
    if (BUMPER_RIGHT == BUMPER_RIGHT_ACTIVE) {
        pressed |= PRESSED_RIGHT;
    }
    SENSOR_LIGHT = !SENSOR_LIGHT_ACTIVE;
}

void on_serial(void) __interrupt(SI0_VECTOR) __using(1) {
    if (RI) {
        uint8_t next = (received_to + 1) & (RECEIVE_RING - 1);
        if (SCON & SCON_FE) {
            SCON &= (uint8_t)~SCON_FE;
            line_error = 1;
        }
        if (next == received_from) {
            line_overrun = 1;
        } else {
            receive_ring[received_to] = SBUF;
            received_to = next;
        }
        RI = 0;
    }
    if (TI) {
        TI = 0;
        if (sent_from == sent_to) {
            is_sending = 0;
        } else {
            SBUF = send_ring[sent_from];
            sent_from = (sent_from + 1) & (SEND_RING - 1);
        }
    }
}

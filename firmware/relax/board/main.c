/* The Relax: its chip's pins as the C cord's board.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "board.h"
#include "cord.h"
#include "crc.h"
#include "interrupts.h"
#include "motion.h"
#include "pins.h"

/* The last bytes of the memory on the chip, outside of what start-up clears, are `cord_kept`. */
__xdata __at(0x03F0) uint8_t kept_memory[sizeof(struct cord_kept)];
void kept_place(void) __naked {
    __asm
        .globl _cord_kept
        _cord_kept = 0x03F0
    __endasm;
}

#define FLASH_BYTES 0x8000U
/* Begins the CRC of the flash, which is no packet. */
#define PROGRAM_MARK 'p'

uint8_t cord_byte;

static uint8_t last_ms;
static uint8_t last_edges[2];
/* The newest sample by light. */
static __data uint8_t lit_now;

/* Called before anything else: motors off, no pulses on the unused ALE pin, the watchdog runs. */
unsigned char _sdcc_external_startup(void) {
    P0 = P0_START;
    P1 = P1_START;
    P2 = P2_START;
    P3 = P3_START;
    AUXR = AUXR_ALEOFF;
    WDT_CONTR = WDT_RUN | WDT_105_MS;
    return 0;
}

/* All of the flash, whose last four bytes make its CRC 0. Takes half a second; the watchdog is fed every 256 bytes. */
uint8_t cord_board_is_program_sound(void) {
    __code const uint8_t *at = 0;
    cord_crc_start(PROGRAM_MARK, 0);
    do {
        cord_crc_take(*at);
        at++;
        if ((uint8_t)(uint16_t)at == 0) {
            cord_board_feed();
        }
    } while ((uint16_t)at != FLASH_BYTES);
    return (cord_crc.b0 | cord_crc.b1 | cord_crc.b2 | cord_crc.b3) == 0;
}

uint8_t cord_board_elapsed_ms(void) {
    uint8_t now_ms = milliseconds;
    uint8_t elapsed_ms = (uint8_t)(now_ms - last_ms);
    last_ms = now_ms;
    return elapsed_ms;
}

uint8_t cord_board_contacts(void) {
    uint8_t lit = lit_p0;
    uint8_t dark = dark_p0;
    uint8_t contacts = 0;
    uint8_t floor;
    lit_now = lit;
    /* A sample counts once: without new ones there is no floor. */
    lit_p0 = 0;
    EA = 0;
    contacts = pressed;
    pressed = 0;
    EA = 1;
    /* A receiver that sees a floor without light sees nothing. */
    floor = lit & (uint8_t)~dark;
    if ((floor & FLOOR_LEFT_OUTER_MASK) == 0) {
        contacts |= CORD_CLIFF_LEFT;
    }
    if ((floor & FLOOR_LEFT_INNER_MASK) == 0 || (floor & FLOOR_RIGHT_INNER_MASK) == 0) {
        contacts |= CORD_CLIFF_MIDDLE;
    }
    if ((floor & FLOOR_RIGHT_OUTER_MASK) == 0) {
        contacts |= CORD_CLIFF_RIGHT;
    }
    if (dark & (FLOOR_LEFT_OUTER_MASK | FLOOR_LEFT_INNER_MASK | FLOOR_RIGHT_INNER_MASK | FLOOR_RIGHT_OUTER_MASK)) {
        contacts |= CORD_CLIFF_BLIND;
    }
    if (WHEEL_DROP == WHEEL_DROP_ACTIVE) {
        contacts |= CORD_WHEEL_DROP;
    }
    return contacts;
}

uint8_t cord_board_overloads(void) {
    uint8_t loads = 0;
    if (WHEEL_LEFT_OVER_CURRENT == WHEEL_LEFT_OVER_CURRENT_ACTIVE) {
        loads |= CORD_LOAD_LEFT;
    }
    if (WHEEL_RIGHT_OVER_CURRENT == WHEEL_RIGHT_OVER_CURRENT_ACTIVE) {
        loads |= CORD_LOAD_RIGHT;
    }
    if (BRUSH_MAIN_OVER_CURRENT == BRUSH_MAIN_OVER_CURRENT_ACTIVE) {
        loads |= CORD_LOAD_BRUSH;
    }
    if (SUCTION_OVER_CURRENT == SUCTION_OVER_CURRENT_ACTIVE) {
        loads |= CORD_LOAD_SUCTION;
    }
    return loads;
}

uint8_t cord_board_is_battery_low(void) {
    return BATTERY_OK != BATTERY_OK_ACTIVE;
}

uint8_t cord_board_wall(void) {
    return (lit_now & (uint8_t)~dark_p0 & WALL_MASK) ? 0xFF : 0;
}

uint8_t cord_board_edges(uint8_t side) {
    uint8_t now = side == 0 ? edges_left : edges_right;
    uint8_t count = (uint8_t)(now - last_edges[side]);
    last_edges[side] = now;
    return count;
}

void cord_board_drive(void) {
    uint8_t is_left_backward = cord_duty[0] < 0;
    uint8_t is_right_backward = cord_duty[1] < 0;
    uint8_t left = (uint8_t)(is_left_backward ? -cord_duty[0] : cord_duty[0]);
    uint8_t right = (uint8_t)(is_right_backward ? -cord_duty[1] : cord_duty[1]);
    EA = 0;
    backward_left = is_left_backward;
    strength_left = left;
    backward_right = is_right_backward;
    strength_right = right;
    EA = 1;
}

void cord_board_clean(uint8_t motors) {
    BRUSH_MAIN = (motors & CORD_LOAD_BRUSH) ? BRUSH_MAIN_ACTIVE : !BRUSH_MAIN_ACTIVE;
    SUCTION = (motors & CORD_LOAD_SUCTION) ? SUCTION_ACTIVE : !SUCTION_ACTIVE;
}

void cord_board_off(void) {
    strength_left = 0;
    strength_right = 0;
    WHEEL_LEFT_FORWARD = !WHEEL_LEFT_FORWARD_ACTIVE;
    WHEEL_LEFT_BACKWARD = !WHEEL_LEFT_BACKWARD_ACTIVE;
    WHEEL_RIGHT_FORWARD = !WHEEL_RIGHT_FORWARD_ACTIVE;
    WHEEL_RIGHT_BACKWARD = !WHEEL_RIGHT_BACKWARD_ACTIVE;
    cord_board_clean(0);
}

uint8_t cord_board_receive(void) {
    if (line_overrun) {
        line_overrun = 0;
        return CORD_RECEIVED_OVERRUN;
    }
    if (line_error) {
        line_error = 0;
        return CORD_RECEIVED_FRAMING_ERROR;
    }
    if (received_from == received_to) {
        return CORD_RECEIVED_NOTHING;
    }
    cord_byte = receive_ring[received_from];
    received_from = (received_from + 1) & (RECEIVE_RING - 1);
    return CORD_RECEIVED_BYTE;
}

uint8_t cord_board_room(void) {
    return (uint8_t)(sent_from - sent_to - 1) & (SEND_RING - 1);
}

void cord_board_send(uint8_t byte) {
    send_ring[sent_to] = byte;
    EA = 0;
    sent_to = (sent_to + 1) & (SEND_RING - 1);
    if (!is_sending) {
        is_sending = 1;
        TI = 1;
    }
    EA = 1;
}

void cord_board_feed(void) {
    WDT_CONTR = WDT_RUN | WDT_105_MS;
}

void main(void) {
    uint8_t index;
    cord_start((uint16_t)((uint16_t)TH0 << 8 | TL0));
    interrupts_start();
    last_ms = 0;
    for (index = 0; index < 2; index++) {
        last_edges[index] = 0;
    }
    for (;;) {
        cord_pass();
    }
}

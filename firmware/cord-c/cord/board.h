/* What a board gives to the C cord: it implements these functions, calls cord_start once and cord_pass for ever.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORD_BOARD_H
#define CORD_BOARD_H

#include <stdint.h>

/* Contacts and floor, bits. Set = pressed, no floor, hanging, sensor without sense. */
#define CORD_BUMPER_LEFT 0x01
#define CORD_BUMPER_RIGHT 0x02
#define CORD_CLIFF_LEFT 0x04
#define CORD_CLIFF_MIDDLE 0x08
#define CORD_CLIFF_RIGHT 0x10
#define CORD_WHEEL_DROP 0x20
#define CORD_CLIFF_BLIND 0x40
#define CORD_BUMPERS (CORD_BUMPER_LEFT | CORD_BUMPER_RIGHT)
#define CORD_CLIFFS (CORD_CLIFF_LEFT | CORD_CLIFF_MIDDLE | CORD_CLIFF_RIGHT)

/* Motors that draw too much, bits; the two below also switch the cleaners. */
#define CORD_LOAD_LEFT 0x01
#define CORD_LOAD_RIGHT 0x02
#define CORD_LOAD_BRUSH 0x04
#define CORD_LOAD_SUCTION 0x08

enum cord_received { CORD_RECEIVED_NOTHING, CORD_RECEIVED_BYTE, CORD_RECEIVED_FRAMING_ERROR, CORD_RECEIVED_OVERRUN };

/* What stays over a reset, but not over a loss of power. */
struct cord_kept {
    uint32_t latched;
    uint16_t boots;
    uint8_t recent_resets;
    uint16_t check; /* of what stands before it */
};

/* Whether the program is as it was built; called once, at the start, before anything may move. */
uint8_t cord_board_is_program_sound(void);
/* Milliseconds since the last call, at most 255. */
uint8_t cord_board_elapsed_ms(void);
/* CORD_BUMPER_LEFT and so on, as they are now. */
uint8_t cord_board_contacts(void);
/* CORD_LOAD_LEFT and so on. */
uint8_t cord_board_overloads(void);
/* Whether the battery has a complaint. */
uint8_t cord_board_is_battery_low(void);
/* Nearness of a wall at the right, 0 = nothing. */
uint8_t cord_board_wall(void);
/* Encoder edges of a wheel, 0 left, 1 right, since the last call. */
uint8_t cord_board_edges(uint8_t side);
/* Drives both wheels at once as `cord_duty` says: -255..255 of full, left and right, 0 = no drive. Acts within a millisecond. In no
 * moment may a wheel be driven ahead harder than the other one back when `cord_duty` does not say so. */
void cord_board_drive(void);
/* Switches brush and suction, CORD_LOAD_BRUSH and CORD_LOAD_SUCTION. */
void cord_board_clean(uint8_t motors);
/* Switches everything off at once. */
void cord_board_off(void);
/* A byte of the line, in `cord_byte`. */
extern uint8_t cord_byte;
uint8_t cord_board_receive(void);
/* Bytes that cord_board_send would take. */
uint8_t cord_board_room(void);
void cord_board_send(uint8_t byte);
/* Tells the watchdog that a whole pass is done. */
void cord_board_feed(void);
/* Memory that a reset leaves alone. */
extern struct cord_kept cord_kept;

#endif

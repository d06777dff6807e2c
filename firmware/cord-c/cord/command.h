/* Commands from text and from binary packets, SPEC.md, sections 6 and 8.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORD_COMMAND_H
#define CORD_COMMAND_H

#include <stdint.h>

/* How strict a packet must be. */
enum cord_form {
    CORD_FORM_CHECKED,    /* all keys of motion, the number of every command that has one */
    CORD_FORM_HAND,       /* without a CRC: some keys may be absent, unknown ones are typing errors */
    CORD_FORM_SEALED_HAND /* with a CRC but without a session */
};

/* Binary kinds, bits. */
#define CORD_BINARY_STATE 1
#define CORD_BINARY_DRIVE 2

/* No radius: straight. */
#define CORD_STRAIGHT INT32_MIN

/* A command; of the values those that it has. */
struct cord_command {
    uint8_t name;       /* CORD_COMMAND_... */
    uint8_t what;       /* motor, inhibit, parameter, row, light, lower version, target of a probe */
    uint8_t detail;     /* upper version, pattern of a light, port of a probe */
    uint8_t flag;       /* undock, charge, binary kinds */
    int32_t value;      /* speed, throttle, length, value, pitch, brightness, baud */
    int32_t second;     /* turn, radius, volume */
    uint16_t lease_ms;  /* lease, or length of a tone */
    uint16_t number;
    uint32_t tick;
};

extern struct cord_command cord_command;

/* Reads the text that was framed last; 0, or why it is refused. `now` stands in for an absent tick. */
uint8_t cord_command_read(uint8_t form, uint32_t now);
/* Reads the `drive` that was framed last. */
uint8_t cord_command_read_drive(void);
/* The number of a packet that was refused, in `cord_number`; false if none could be read. */
uint8_t cord_command_number(void);
/* Whether the text that was framed last is a `stop`, which is obeyed even in a damaged packet. */
uint8_t cord_command_is_stop(void);
/* Whether it consists of the pattern for the baud rate only. */
uint8_t cord_command_is_pattern(void);

#endif

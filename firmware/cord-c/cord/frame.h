/* From bytes to packets: separators, poison, stuffing and CRC of SPEC.md, sections 1, 2 and 8.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORD_FRAME_H
#define CORD_FRAME_H

#include "port.h"
#include "wire.h"
#include <stdint.h>

/* The longest command: that of the protocol, or less where memory is scarce, which `hello` tells. */
#ifndef CORD_PACKET_MOST
#define CORD_PACKET_MOST CORD_PACKET_BYTES_MAX
#endif

/* What a byte ended. */
enum cord_framed {
    CORD_FRAMED_NOTHING,
    CORD_FRAMED_UNCHECKED,      /* text without a CRC */
    CORD_FRAMED_CHECKED,        /* text with the right CRC, which is cut off */
    CORD_FRAMED_BAD_CRC,        /* text whose CRC is not that of the session; it is cut off */
    CORD_FRAMED_BINARY,         /* right CRC; kind and body */
    CORD_FRAMED_BINARY_BAD_CRC, /* or too short for one */
    CORD_FRAMED_TOO_LONG,       /* this and the following: poisoned */
    CORD_FRAMED_CONTROL_BYTE,
    CORD_FRAMED_FRAMING_ERROR,
    CORD_FRAMED_OVERRUN
};

/* The packet that was ended last, until the next byte is taken; a binary one with its kind first, a text with a 0 behind it. */
extern uint8_t cord_packet[CORD_PACKET_MOST + 1];
/* How long it is, without its CRC. */
extern uint16_t cord_packet_length;
/* Bit 7 is set if a byte of a text is not ASCII. */
extern CORD_NEAR uint8_t cord_packet_bits;

/* Starts with an empty packet and no session. */
void cord_frame_start(void);
/* CRCs are those of `session` from the next packet on. */
void cord_frame_set_session(uint16_t session);
/* Takes a byte of the line. */
uint8_t cord_frame_take(uint8_t byte);
/* Drops everything up to the next separator; `reason` is one of the poisoned of `cord_framed`. */
void cord_frame_poison(uint8_t reason);
/* Whether the last packet, one with a bad CRC, has that of no session. */
uint8_t cord_frame_has_crc_of_no_session(void);

#endif

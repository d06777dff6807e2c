/* From bytes to packets. The digest follows the input by the length of a CRC, because nobody knows that bytes are the CRC until
 * the separator comes: work per byte is bounded, and little is left for the separator.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "frame.h"
#include "crc.h"
#include "port.h"

#define TEXT_CRC_BYTES 9 /* '*' and eight digits */
#define BINARY_CRC_BYTES 4
/* The first byte that is never special inside of a packet. */
#define PLAIN_FROM 0x20

enum form { FORM_TEXT, FORM_BINARY, FORM_STUFFING };

uint8_t cord_packet[CORD_PACKET_MOST + 1];
uint16_t cord_packet_length;
CORD_NEAR uint8_t cord_packet_bits;
/* The same of the packet that is coming in. */
static CORD_NEAR uint8_t bits;

static CORD_NEAR uint16_t length;
static CORD_NEAR uint8_t form;
/* Why the packet is dropped, 0 if it is not. */
static CORD_NEAR uint8_t poison;
static CORD_NEAR struct cord_crc digest;
static struct cord_crc start;
/* The CRC that the last text came with. */
static struct cord_crc found;

static void restart(void) {
    length = 0;
    bits = 0;
    form = FORM_TEXT;
    poison = 0;
    digest = start;
}

void cord_frame_set_session(uint16_t session) {
    cord_crc_start('>', session);
    start = cord_crc;
    if (length == 0) {
        digest = start;
    }
}

void cord_frame_start(void) {
    length = 0;
    cord_packet_length = 0;
    cord_frame_set_session(0);
    restart();
}

void cord_frame_poison(uint8_t reason) {
    if (poison == 0) {
        poison = reason;
    }
}

/* Stores a byte, and takes into the digest the one that can no longer be part of the CRC. */
static void keep(uint8_t byte, uint8_t crc_bytes) {
    if (length == CORD_PACKET_MOST) {
        cord_frame_poison(CORD_FRAMED_TOO_LONG);
        return;
    }
    cord_packet[length] = byte;
    bits |= byte;
    length++;
    if (length > crc_bytes) {
        uint8_t settled = cord_packet[length - 1 - crc_bytes];
        CORD_CRC_TAKE(digest, settled);
    }
}

static void unstuff(uint8_t byte) {
    byte ^= CORD_STUFFED_BIT;
    if (byte >= CORD_STUFFING && byte <= CORD_SEPARATOR) {
        form = FORM_BINARY;
        keep(byte, BINARY_CRC_BYTES);
    } else {
        cord_frame_poison(CORD_FRAMED_CONTROL_BYTE);
    }
}

static uint8_t nibble(uint8_t digit) {
    if (digit >= '0' && digit <= '9') {
        return (uint8_t)(digit - '0');
    }
    if (digit >= 'A' && digit <= 'F') {
        return (uint8_t)(digit - 'A' + 10);
    }
    return 0xFF;
}

/* Two digits as a byte; 0 in `is_hex` when they are none. */
static uint8_t is_hex;
static uint8_t pair(uint16_t at) {
    uint8_t high = nibble(cord_packet[at]);
    uint8_t low = nibble(cord_packet[at + 1]);
    if (high > 15 || low > 15) {
        is_hex = 0;
    }
    return (uint8_t)((uint8_t)(high << 4) | (low & 15));
}

/* Whether the last nine bytes have the form of a CRC; it is left in `found`. */
static uint8_t has_crc(void) {
    uint16_t at;
    if (length < TEXT_CRC_BYTES) {
        return 0;
    }
    at = length - TEXT_CRC_BYTES;
    if (cord_packet[at] != '*') {
        return 0;
    }
    is_hex = 1;
    found.b3 = pair(at + 1);
    found.b2 = pair(at + 3);
    found.b1 = pair(at + 5);
    found.b0 = pair(at + 7);
    return is_hex;
}

/* Whether the CRC that was worked out is the one that came. */
static uint8_t is_right(void) {
    cord_crc_finish(cord_packet_length);
    return cord_crc.b0 == found.b0 && cord_crc.b1 == found.b1 && cord_crc.b2 == found.b2 && cord_crc.b3 == found.b3;
}

static uint8_t matches(void) {
    cord_crc = digest;
    return is_right();
}

static uint8_t finish_text(void) {
    if (length == 0) {
        return CORD_FRAMED_NOTHING;
    }
    cord_packet_length = length;
    cord_packet_bits = bits;
    cord_packet[length] = 0;
    if (!has_crc()) {
        return CORD_FRAMED_UNCHECKED;
    }
    cord_packet_length = length - TEXT_CRC_BYTES;
    cord_packet[cord_packet_length] = 0;
    return matches() ? CORD_FRAMED_CHECKED : CORD_FRAMED_BAD_CRC;
}

static uint8_t finish_binary(void) {
    if (length <= BINARY_CRC_BYTES) {
        return CORD_FRAMED_BINARY_BAD_CRC;
    }
    cord_packet_length = length - BINARY_CRC_BYTES;
    found.b0 = cord_packet[cord_packet_length];
    found.b1 = cord_packet[cord_packet_length + 1];
    found.b2 = cord_packet[cord_packet_length + 2];
    found.b3 = cord_packet[cord_packet_length + 3];
    return matches() ? CORD_FRAMED_BINARY : CORD_FRAMED_BINARY_BAD_CRC;
}

static uint8_t finish(void) {
    uint8_t framed = poison;
    if (framed == 0) {
        switch (form) {
        case FORM_TEXT:
            framed = finish_text();
            break;
        case FORM_BINARY:
            framed = finish_binary();
            break;
        default:
            framed = CORD_FRAMED_CONTROL_BYTE;
            break;
        }
    }
    restart();
    return framed;
}

uint8_t cord_frame_take(uint8_t byte) {
    if (byte == CORD_SEPARATOR || byte == CORD_SEPARATOR_2016) {
        return finish();
    }
    if (poison != 0) {
        return CORD_FRAMED_NOTHING;
    }
    if (form == FORM_TEXT) {
        if (byte < PLAIN_FROM) {
            cord_frame_poison(CORD_FRAMED_CONTROL_BYTE);
        } else if (length == 0 && byte >= CORD_BINARY_KIND_MIN) {
            form = FORM_BINARY;
            keep(byte, BINARY_CRC_BYTES);
        } else {
            keep(byte, TEXT_CRC_BYTES);
        }
    } else if (form == FORM_STUFFING) {
        unstuff(byte);
    } else if (byte == CORD_STUFFING) {
        form = FORM_STUFFING;
    } else {
        keep(byte, BINARY_CRC_BYTES);
    }
    return CORD_FRAMED_NOTHING;
}

uint8_t cord_frame_has_crc_of_no_session(void) {
    uint16_t at;
    cord_crc_start('>', 0);
    for (at = 0; at < cord_packet_length; at++) {
        cord_crc_take(cord_packet[at]);
    }
    return is_right();
}

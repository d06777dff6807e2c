/* CRC-32C of packets, a byte at a time, from four tables of 256 bytes: no shift of 32 bits.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORD_CRC_H
#define CORD_CRC_H

#include "port.h"
#include <stdint.h>

/* A running CRC, lowest byte first. */
struct cord_crc {
    uint8_t b0, b1, b2, b3;
};

extern const uint8_t cord_crc_table_0[256];
extern const uint8_t cord_crc_table_1[256];
extern const uint8_t cord_crc_table_2[256];
extern const uint8_t cord_crc_table_3[256];

/* Takes a byte into the CRC that is named, a variable. */
#define CORD_CRC_TAKE(crc, byte)                                       \
    do {                                                               \
        uint8_t crc_index = (uint8_t)((crc).b0 ^ (byte));              \
        (crc).b0 = (uint8_t)((crc).b1 ^ cord_crc_table_0[crc_index]);  \
        (crc).b1 = (uint8_t)((crc).b2 ^ cord_crc_table_1[crc_index]);  \
        (crc).b2 = (uint8_t)((crc).b3 ^ cord_crc_table_2[crc_index]);  \
        (crc).b3 = cord_crc_table_3[crc_index];                        \
    } while (0)

/* The CRC that the functions work on. */
extern CORD_NEAR struct cord_crc cord_crc;
/* Begins a CRC: direction '>' or '<', then the session. */
void cord_crc_start(uint8_t direction, uint16_t session);
/* Takes a byte. */
void cord_crc_take(uint8_t byte);
/* Ends it with the number of bytes of the packet. */
void cord_crc_finish(uint16_t length);

#endif

/* CRC-32C of packets: beginning and end, which are rare, as functions.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "crc.h"

CORD_NEAR struct cord_crc cord_crc;

void cord_crc_take(uint8_t byte) {
    CORD_CRC_TAKE(cord_crc, byte);
}

void cord_crc_start(uint8_t direction, uint16_t session) {
    cord_crc.b0 = cord_crc.b1 = cord_crc.b2 = cord_crc.b3 = 0xFF;
    cord_crc_take(direction);
    cord_crc_take((uint8_t)session);
    cord_crc_take((uint8_t)(session >> 8));
}

void cord_crc_finish(uint16_t length) {
    cord_crc_take((uint8_t)length);
    cord_crc_take((uint8_t)(length >> 8));
    cord_crc.b0 = (uint8_t)~cord_crc.b0;
    cord_crc.b1 = (uint8_t)~cord_crc.b1;
    cord_crc.b2 = (uint8_t)~cord_crc.b2;
    cord_crc.b3 = (uint8_t)~cord_crc.b3;
}

/* Numbers, exactly: from a spelling to an integer in counts of a span. Digits are taken up to the last one that counts, and the
 * one behind it rounds; so 32 bits are enough for any spelling.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "frame.h"
#include "scan.h"
#include "wire.h"
#include "port.h"

/* Far beyond any number of the wire, far below an overflow. */
#define EXPONENT_MAX 10000
/* A tenth of the largest number of 32 bits. */
#define TENTH 429496729UL

CORD_NEAR uint32_t cord_number;

/* Where the digits begin, and how many stand before the point. */
static uint16_t first;
static int16_t before_point;
/* Power of ten at the end of the spelling. */
static CORD_NEAR int16_t exponent;

static uint8_t digit_at(uint16_t place) {
    uint8_t byte = place < cord_packet_length ? (uint8_t)(cord_packet[place] - '0') : 0xFF;
    return byte <= 9 ? byte : 0xFF;
}

/* Finds the parts of a spelling that the scanner has accepted. */
static void dissect(uint16_t place) {
    uint8_t is_negative;
    first = place;
    while (digit_at(place) != 0xFF) {
        place++;
    }
    before_point = (int16_t)(place - first);
    if (place < cord_packet_length && cord_packet[place] == '.') {
        place++;
        while (digit_at(place) != 0xFF) {
            place++;
        }
    }
    exponent = 0;
    if (place >= cord_packet_length || (cord_packet[place] | 0x20) != 'e') {
        return;
    }
    place++;
    is_negative = cord_packet[place] == '-';
    if (is_negative || cord_packet[place] == '+') {
        place++;
    }
    while (digit_at(place) != 0xFF) {
        exponent = (int16_t)(exponent > EXPONENT_MAX / 10 - 1 ? EXPONENT_MAX
                                                             : exponent * 10 + digit_at(place));
        place++;
    }
    if (is_negative) {
        exponent = (int16_t)-exponent;
    }
}

static CORD_NEAR uint16_t cursor;

/* The next digit, the point skipped; 0xFF behind the last one. */
static uint8_t next_digit(void) {
    uint8_t digit;
    if (cursor < cord_packet_length && cord_packet[cursor] == '.') {
        cursor++;
    }
    digit = digit_at(cursor);
    if (digit != 0xFF) {
        cursor++;
    }
    return digit;
}

/* The magnitude in counts of 10^-decimals, in `cord_number`; false if it does not fit. */
static uint8_t magnitude(uint8_t decimals) {
    int16_t taken = (int16_t)(before_point + exponent + decimals);
    uint8_t digit;
    cord_number = 0;
    if (taken < 0) {
        return 1;
    }
    cursor = first;
    for (; taken > 0; taken--) {
        digit = next_digit();
        if (digit == 0xFF) {
            if (cord_number == 0) {
                return 1;
            }
            digit = 0;
        }
        if (cord_number > TENTH || (cord_number == TENTH && digit > 5)) {
            return 0;
        }
        cord_number = (cord_number << 3) + (cord_number << 1) + digit;
    }
    digit = next_digit();
    if (digit != 0xFF && digit >= 5) {
        cord_number++;
        return cord_number != 0;
    }
    return 1;
}

uint8_t cord_number_read(uint8_t place, uint8_t span) {
    uint8_t is_negative = cord_packet[place] == '-';
    dissect((uint16_t)place + is_negative);
    if (!magnitude(cord_span_decimals[span])) {
        return 0;
    }
    if (cord_number == 0) {
        is_negative = 0;
    }
    if (is_negative) {
        if (cord_number > cord_span_below[span]) {
            return 0;
        }
        cord_number = 0 - cord_number;
        return 1;
    }
    return cord_number >= cord_span_least[span] && cord_number <= cord_span_most[span];
}

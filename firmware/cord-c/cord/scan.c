/* JSON straight from the packet.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "scan.h"
#include "frame.h"
#include "wire.h"
#include "port.h"

/* Deepest nesting of unknown values: a bit each in `nesting`. */
#define DEPTH_MAX 32

CORD_NEAR struct cord_piece cord_key;
CORD_NEAR struct cord_piece cord_value;

static CORD_NEAR uint16_t at;
/* Whether a member was read already. */
static CORD_NEAR uint8_t has_begun;

/* The byte at hand; 0, which no packet holds, at the end. */
#define peek() (cord_packet[at])

static void skip_spaces(void) {
    while (peek() == ' ') {
        at++;
    }
}

static uint8_t token(void) {
    uint8_t byte;
    skip_spaces();
    byte = peek();
    if (byte != 0) {
        at++;
    }
    return byte;
}

/* Whether the packet is UTF-8. `least` and `most` bound the next byte of a sequence, `more` is how many come. */
static uint8_t is_utf8(void) {
    uint16_t place;
    uint8_t more = 0;
    uint8_t least = 0x80;
    uint8_t most = 0xBF;
    for (place = 0; place < cord_packet_length; place++) {
        uint8_t byte = cord_packet[place];
        if (more != 0) {
            if (byte < least || byte > most) {
                return 0;
            }
            more--;
            least = 0x80;
            most = 0xBF;
        } else if (byte >= 0x80) {
            if (byte < 0xC2 || byte > 0xF4) {
                return 0;
            }
            more = byte < 0xE0 ? 1 : byte < 0xF0 ? 2 : 3;
            least = byte == 0xE0 ? 0xA0 : byte == 0xF0 ? 0x90 : 0x80;
            most = byte == 0xED ? 0x9F : byte == 0xF4 ? 0x8F : 0xBF;
        }
    }
    return more == 0;
}

static uint8_t is_hex_digit(uint8_t byte) {
    return (byte >= '0' && byte <= '9') || (byte >= 'A' && byte <= 'F') || (byte >= 'a' && byte <= 'f');
}

static uint8_t escape(void) {
    uint8_t digits;
    uint8_t kind = peek();
    if (kind == 0) {
        return 0;
    }
    at++;
    switch (kind) {
    case '"':
    case '\\':
    case '/':
    case 'b':
    case 'f':
    case 'n':
    case 'r':
    case 't':
        return 1;
    case 'u':
        for (digits = 0; digits < 4; digits++) {
            if (!is_hex_digit(peek())) {
                return 0;
            }
            at++;
        }
        return 1;
    default:
        return 0;
    }
}

/* The rest of a string after its opening quote. */
static uint8_t string(struct cord_piece *piece) {
    uint16_t begin = at;
    piece->kind = CORD_KIND_TEXT;
    piece->at = (uint8_t)begin;
    for (;;) {
        uint8_t byte = peek();
        if (byte < 0x20) {
            return 0;
        }
        at++;
        if (byte == '"') {
            piece->length = (uint8_t)(at - 1 - begin);
            return 1;
        }
        if (byte == '\\' && !escape()) {
            return 0;
        }
    }
}

static uint8_t is_digit(uint8_t byte) {
    return byte >= '0' && byte <= '9';
}

static uint8_t skip_digits(void) {
    uint8_t count = 0;
    while (is_digit(peek())) {
        at++;
        count = 1;
    }
    return count;
}

/* A number as JSON spells it. */
static uint8_t number(void) {
    if (peek() == '-') {
        at++;
    }
    if (peek() == '0') {
        at++;
        if (is_digit(peek())) {
            return 0;
        }
    } else if (!skip_digits()) {
        return 0;
    }
    if (peek() == '.') {
        at++;
        if (!skip_digits()) {
            return 0;
        }
    }
    if (peek() == 'e' || peek() == 'E') {
        at++;
        if (peek() == '-' || peek() == '+') {
            at++;
        }
        return skip_digits();
    }
    return 1;
}

static uint8_t literal(const char *word, uint8_t kind) {
    while (*word != 0) {
        if (peek() != (uint8_t)*word) {
            return 0;
        }
        at++;
        word++;
    }
    cord_value.kind = kind;
    return 1;
}

static uint8_t scalar(void) {
    switch (peek()) {
    case '"':
        at++;
        return string(&cord_value);
    case 't':
        return literal("true", CORD_KIND_TRUE);
    case 'f':
        return literal("false", CORD_KIND_FALSE);
    case 'n':
        return literal("null", CORD_KIND_NULL);
    default:
        cord_value.kind = CORD_KIND_NUMBER;
        cord_value.at = (uint8_t)at;
        return number();
    }
}

/* Innermost bracket at bit 0: 1 for an object. */
static uint32_t nesting;
static CORD_NEAR uint8_t depth;

enum step { STEP_VALUE, STEP_CLOSED, STEP_BROKEN };

/* After a value or an opening bracket: goes to the next value, or to what follows the outermost bracket. */
static uint8_t to_next_value(uint8_t has_opened) {
    uint8_t is_empty = has_opened;
    while (depth > 0) {
        uint8_t is_object = (uint8_t)nesting & 1;
        skip_spaces();
        if (peek() == (is_object ? '}' : ']')) {
            at++;
            nesting >>= 1;
            depth--;
            is_empty = 0;
            continue;
        }
        if (!is_empty && token() != ',') {
            return STEP_BROKEN;
        }
        if (is_object && (token() != '"' || !string(&cord_value) || token() != ':')) {
            return STEP_BROKEN;
        }
        return STEP_VALUE;
    }
    return STEP_CLOSED;
}

static uint8_t composite(void) {
    nesting = 0;
    depth = 0;
    for (;;) {
        uint8_t byte;
        uint8_t step;
        uint8_t has_opened = 0;
        skip_spaces();
        byte = peek();
        if (byte == '{' || byte == '[') {
            at++;
            depth++;
            nesting <<= 1;
            if (byte == '{') {
                nesting |= 1;
            }
            has_opened = 1;
        } else if (!scalar()) {
            return 0;
        }
        if (depth > DEPTH_MAX) {
            return 0;
        }
        step = to_next_value(has_opened);
        if (step != STEP_VALUE) {
            cord_value.kind = CORD_KIND_COMPOSITE;
            return step == STEP_CLOSED;
        }
    }
}

uint8_t cord_scan_begin(void) {
    at = 0;
    has_begun = 0;
    return (cord_packet_bits < 0x80 || is_utf8()) && token() == '{';
}

uint8_t cord_scan_next(void) {
    uint8_t byte = token();
    uint8_t is_first = !has_begun;
    has_begun = 1;
    if (byte == '}') {
        skip_spaces();
        return at == cord_packet_length ? CORD_SCAN_END : CORD_SCAN_BROKEN;
    }
    if (!is_first) {
        if (byte != ',') {
            return CORD_SCAN_BROKEN;
        }
        byte = token();
    }
    if (byte != '"' || !string(&cord_key) || token() != ':') {
        return CORD_SCAN_BROKEN;
    }
    skip_spaces();
    byte = peek();
    if (byte == '{' || byte == '[') {
        return composite() ? CORD_SCAN_MEMBER : CORD_SCAN_BROKEN;
    }
    return scalar() ? CORD_SCAN_MEMBER : CORD_SCAN_BROKEN;
}

uint8_t cord_name_find(const uint8_t *names, uint8_t place, uint8_t length) {
    uint8_t index = 0;
    uint8_t size;
    while ((size = *names) != 0) {
        names++;
        if (size == length) {
            uint8_t same = 0;
            while (same < size && names[same] == cord_packet[(uint8_t)(place + same)]) {
                same++;
            }
            if (same == size) {
                return index;
            }
        }
        names += size;
        index++;
    }
    return 0xFF;
}

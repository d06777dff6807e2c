/* Values in the templates of transmit.c: names from code memory, and a decimal writer without division.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "value.h"
#include "arming.h"
#include "board.h"
#include "cord.h"
#include "inhibit.h"
#include "motion.h"
#include "session.h"
#include "wire.h"
#include "port.h"

#define DIGITS 10
#define INHIBITS 28
/* No further name of an inhibit begins behind this place, so that a packet stays within its limit. */
#define NAMES_UNTIL 190
#define FLAGS 12

static const uint32_t powers[DIGITS] = {1000000000UL, 100000000UL, 10000000UL, 1000000UL, 100000UL,
                                        10000UL,      1000UL,      100UL,      10UL,      1UL};
static const char flag_letters[] = "bBcmCwWxdhsv";
static const char phase_letters[] = "idmwr";

uint16_t cord_steps_hz;
uint16_t cord_bytes_in;
uint16_t cord_bytes_out;

/* What is being written: characters, or a name in code memory. */
static char digits[DIGITS + 3];
static const char *CORD_NEAR from;
static CORD_NEAR uint8_t left;
/* Inhibits whose names follow, from `next_name` on. */
static uint32_t names;
static uint8_t next_name;
static uint8_t has_name;
static uint16_t written;

void cord_value_begin(void) {
    left = 0;
    names = 0;
    written = 0;
}

static void put(char letter) {
    digits[left] = letter;
    left++;
}

static void put_number(uint32_t value) {
    uint8_t place;
    uint8_t has_begun = 0;
    for (place = 0; place < DIGITS; place++) {
        uint32_t power = powers[place];
        char digit = '0';
        while (value >= power) {
            value -= power;
            digit++;
        }
        if (has_begun || digit != '0' || place == DIGITS - 1) {
            put(digit);
            has_begun = 1;
        }
    }
}

static void put_signed(int32_t value) {
    if (value < 0) {
        put('-');
        put_number(0 - (uint32_t)value);
    } else {
        put_number((uint32_t)value);
    }
}

static void put_text(const char *word) {
    from = word;
    while (word[left] != 0) {
        left++;
    }
}

/* The name at an index of a list of names. */
static void put_name(const uint8_t *list, uint8_t index) {
    while (index != 0) {
        list += *list + 1;
        index--;
    }
    left = *list;
    from = (const char *)(list + 1);
}

static void put_hex(uint8_t byte) {
    uint8_t high = byte >> 4;
    uint8_t low = byte & 15;
    put((char)(high < 10 ? '0' + high : 'a' - 10 + high));
    put((char)(low < 10 ? '0' + low : 'a' - 10 + low));
}

static void put_flags(void) {
    uint16_t flags = cord_flags();
    uint8_t index;
    for (index = 0; index < FLAGS; index++) {
        if (flags & 1) {
            put(flag_letters[index]);
        }
        flags >>= 1;
    }
}

static void put_angle(void) {
    uint8_t pressed = (uint8_t)cord_fact.bits & CORD_BUMPERS;
    put_signed(pressed == CORD_BUMPER_LEFT ? 45 : pressed == CORD_BUMPER_RIGHT ? -45 : 0);
}

static void put_binary_kinds(void) {
    static const char *const words[4] = {"", "state", "drive", "state drive"};
    put_text(words[cord_binary & 3]);
}

static void put_motor(void) {
    static const uint8_t motors[] = {CORD_MOTOR_WHEEL_LEFT, CORD_MOTOR_WHEEL_RIGHT, CORD_MOTOR_BRUSH_MAIN,
                                     CORD_MOTOR_VACUUM};
    put_name(cord_names_motor, motors[(uint8_t)cord_fact.bits & 3]);
}

#define CODE(letters) ((uint8_t)(letters)[0])

/* Values of the session and of events. */
static void expand_fact(uint8_t code) {
    if (code == CODE(V_NUMBER)) {
        if (cord_reply.kind == CORD_REPLY_NUMBERED) {
            put_number(cord_reply.number);
        } else {
            put_text("null");
        }
    } else if (code == CODE(V_REFUSAL)) {
        put_name(cord_names_refusal, (uint8_t)(cord_reply.refusal - 1));
    } else if (code == CODE(V_FACT_NUMBER)) {
        put_number(cord_fact_number);
    } else if (code == CODE(V_FACT_TICK)) {
        put_number(cord_fact.tick);
    } else if (code == CODE(V_FACT_BITS)) {
        put_number(cord_fact.bits);
    } else if (code == CODE(V_NAMES)) {
        names = cord_fact.bits;
        next_name = 0;
        has_name = 0;
    } else if (code == CODE(V_ANGLE)) {
        put_angle();
    } else {
        put_motor();
    }
}

/* Values of the robot. */
static void expand_robot(uint8_t code) {
    if (code == CODE(V_STEPS)) {
        put_number(cord_steps_hz);
    } else if (code == CODE(V_BYTES_IN)) {
        put_number(cord_bytes_in);
    } else if (code == CODE(V_BYTES_OUT)) {
        put_number(cord_bytes_out);
    } else if (code == CODE(V_ARMING)) {
        put_name(cord_names_arming, cord_arming_state());
    } else if (code == CODE(V_LEFT)) {
        put_signed(cord_total[0]);
    } else if (code == CODE(V_RIGHT)) {
        put_signed(cord_total[1]);
    } else if (code == CODE(V_WALL)) {
        put_hex(cord_board_wall());
    } else if (code == CODE(V_FLAGS)) {
        put_flags();
    } else if (code == CODE(V_PHASE)) {
        put(phase_letters[cord_phase()]);
    } else {
        put_number(cord_inhibits);
    }
}

static void expand(uint8_t code) {
    from = digits;
    if (code >= CODE(V_BIT_0)) {
        put_text((cord_fact.bits >> (code - CODE(V_BIT_0))) & 1 ? "true" : "false");
    } else if (code >= CODE(V_TOTAL_0)) {
        put_number(cord_link_totals[code - CODE(V_TOTAL_0)]);
    } else if (code >= CODE(V_STEPS)) {
        expand_robot(code);
    } else if (code >= CODE(V_NUMBER)) {
        expand_fact(code);
    } else if (code == CODE(V_SESSION)) {
        put_number(cord_session);
    } else if (code == CODE(V_BOOTS)) {
        put_number(cord_kept.boots);
    } else if (code == CODE(V_RESET)) {
        put_text(cord_is_first_start ? "power-on" : "unknown");
    } else if (code == CODE(V_BINARY)) {
        put_binary_kinds();
    } else {
        put_number(cord_now);
    }
}

/* Goes to the next name of an inhibit; the space before it, or 0 if none follows directly. */
static uint8_t step_names(void) {
    while (next_name < INHIBITS && ((names >> next_name) & 1) == 0) {
        next_name++;
    }
    if (next_name == INHIBITS || written > NAMES_UNTIL) {
        names = 0;
        return 0;
    }
    names &= ~((uint32_t)1 << next_name);
    put_name(cord_names_inhibit, next_name);
    if (has_name) {
        return ' ';
    }
    has_name = 1;
    return 0;
}

uint8_t cord_value_next(const char **text) {
    uint8_t byte;
    written++;
    for (;;) {
        if (left != 0) {
            left--;
            return (uint8_t)*from++;
        }
        if (names != 0) {
            byte = step_names();
            if (byte != 0) {
                return byte;
            }
            continue;
        }
        byte = (uint8_t)**text;
        if (byte == 0) {
            return 0;
        }
        (*text)++;
        if (byte < 0x80) {
            return byte;
        }
        expand(byte);
    }
}

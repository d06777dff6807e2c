/* Who may move the robot. A state is a pattern in which no two differ by fewer than sixteen bits, so that no flip of a few bits
 * gives a permission.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "arming.h"
#include "cordlib-rules.h"
#include "inhibit.h"
#include "wire.h"

#define ARMED 0x55555555UL
#define HAND 0x0F0F0F0FUL
#define LOCKED 0x0000FFFFUL

static uint32_t code;
static uint16_t holder;
/* Milliseconds since the last motion of a person who types. */
static uint16_t quiet_ms;
static uint8_t is_stopped;
static uint8_t is_link_lost;

void cord_arming_start(void) {
    code = LOCKED;
    is_stopped = 0;
    is_link_lost = 0;
}

void cord_arming_arm(uint16_t by) {
    holder = by;
    quiet_ms = 0;
    is_stopped = 0;
    is_link_lost = 0;
    code = by == 0 ? HAND : ARMED;
}

void cord_arming_lock(void) {
    code = LOCKED;
}

void cord_arming_stop(void) {
    code = LOCKED;
    is_stopped = 1;
}

uint8_t cord_arming_state(void) {
    if (code == ARMED) {
        return CORD_ARMING_ARMED;
    }
    return code == HAND ? CORD_ARMING_HAND : CORD_ARMING_LOCKED;
}

uint8_t cord_arming_lets_move(uint16_t by) {
    return cord_arming_state() != CORD_ARMING_LOCKED && holder == by;
}

void cord_arming_renew(void) {
    quiet_ms = 0;
}

void cord_arming_hear(void) {
    quiet_ms = 0;
    is_link_lost = 0;
}

void cord_arming_lose_link(void) {
    is_link_lost = 1;
}

uint8_t cord_arming_pass(uint16_t session, uint8_t elapsed_ms) {
    if (cord_arming_state() == CORD_ARMING_LOCKED) {
        return 0;
    }
    if (holder == 0) {
        quiet_ms += elapsed_ms;
    }
    if (holder != session || quiet_ms >= CORD_ARMING_QUIET_MS) {
        code = LOCKED;
        return 1;
    }
    return 0;
}

uint32_t cord_arming_inhibits(void) {
    uint32_t bits = 0;
    if (cord_arming_state() == CORD_ARMING_LOCKED) {
        bits |= CORD_BIT(CORD_INHIBIT_NOT_ARMED);
    }
    if (is_link_lost) {
        bits |= CORD_BIT(CORD_INHIBIT_LINK_LOST);
    }
    if (is_stopped) {
        bits |= CORD_BIT(CORD_INHIBIT_STOPPED);
    }
    return bits;
}

/* Brush, side brush and suction. Their motors are switched on and off, and turn one way. One line serves side brush and suction:
 * it is on while both are wanted, so that nothing turns without a lease of its own.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cleaning.h"
#include "arming.h"
#include "board.h"
#include "inhibit.h"
#include "wire.h"

#define CLEANERS 3
/* Side brushes and suction. */
#define BOTH 6

uint8_t cord_running;

static uint16_t lease_ms[CLEANERS];
/* Whether there may be a lease. */
static uint8_t has_lease;

void cord_cleaning_forget(void) {
    uint8_t index;
    for (index = 0; index < CLEANERS; index++) {
        lease_ms[index] = 0;
    }
    has_lease = 0;
}

static uint8_t place_of(uint8_t motor) {
    switch (motor) {
    case CORD_MOTOR_BRUSH_MAIN:
        return 0;
    case CORD_MOTOR_BRUSH_SIDES:
        return 1;
    case CORD_MOTOR_VACUUM:
        return 2;
    default:
        return CLEANERS;
    }
}

uint8_t cord_cleaning_command(uint8_t motor, int32_t throttle, uint16_t lease) {
    uint8_t place = place_of(motor);
    if (place == CLEANERS) {
        return CORD_REFUSAL_ABSENT;
    }
    if (throttle < 0) {
        return CORD_REFUSAL_RANGE;
    }
    if (!cord_permits_cleaners()) {
        return CORD_REFUSAL_INHIBITED;
    }
    if (throttle != 0 && (cord_running & (1 << place)) == 0 &&
        (cord_inhibits & (CORD_BIT(CORD_INHIBIT_BUMPER) | CORD_BIT(CORD_INHIBIT_WHEEL_DROP))) != 0) {
        return CORD_REFUSAL_INHIBITED;
    }
    lease_ms[place] = throttle == 0 ? 0 : lease;
    has_lease = 1;
    return 0;
}

void cord_cleaning_expire(uint8_t elapsed_ms) {
    uint8_t index;
    if (!has_lease) {
        return;
    }
    for (index = 0; index < CLEANERS; index++) {
        lease_ms[index] = (uint16_t)(lease_ms[index] > elapsed_ms ? lease_ms[index] - elapsed_ms : 0);
    }
}

void cord_cleaning_apply(void) {
    uint8_t running = 0;
    uint8_t index;
    if (!has_lease && cord_running == 0) {
        return;
    }
    if (cord_arming_state() == CORD_ARMING_LOCKED || !cord_permits_cleaners()) {
        cord_cleaning_forget();
    }
    for (index = 0; index < CLEANERS; index++) {
        if (lease_ms[index] != 0) {
            running |= (uint8_t)(1 << index);
        }
    }
    if ((running & BOTH) != BOTH) {
        running &= (uint8_t)~BOTH;
    }
    if (running != cord_running) {
        cord_running = running;
        cord_board_clean((uint8_t)((running & 1 ? CORD_LOAD_BRUSH : 0) | (running & BOTH ? CORD_LOAD_SUCTION : 0)));
    }
}

/* The main loop: senses, reflexes, commands, motion, outputs, telemetry, in this order.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cord.h"
#include "arming.h"
#include "board.h"
#include "cleaning.h"
#include "command.h"
#include "crc.h"
#include "cordlib-rules.h"
#include "inhibit.h"
#include "machine.h"
#include "motion.h"
#include "session.h"
#include "transmit.h"
#include "wire.h"
#include <stddef.h>

/* Most bytes taken from the line in one pass, so that no flood delays the reflexes. */
#define BYTES_IN_PASS 16
#define CONTROL_MS 10
/* Begins the CRC of what is kept, which is no packet. */
#define KEPT_MARK 'k'
/* A session's seed differs from start to start: a large odd number, times their count. */
#define SEED_STEP 0x9E3779B9UL
/* Millionths of full drive in a 255th, nearly. */
#define DUTY_STEP 3921

uint8_t cord_is_first_start;

static uint8_t control_ms;
static uint8_t told_contacts;
static uint32_t told_inhibits;

/* Two bytes of the CRC of what is kept: memory that was without power passes once in 65,536 times. */
static uint16_t kept_check(void) {
    const uint8_t *byte = (const uint8_t *)&cord_kept;
    uint8_t left;
    cord_crc_start(KEPT_MARK, 0);
    for (left = offsetof(struct cord_kept, check); left != 0; left--) {
        cord_crc_take(*byte++);
    }
    return (uint16_t)((uint16_t)((uint16_t)cord_crc.b1 << 8) | cord_crc.b0);
}

void cord_kept_seal(void) {
    cord_kept.check = kept_check();
}

void cord_forget_resets(void) {
    cord_kept.recent_resets = 0;
    cord_kept_seal();
}

/* Takes up what was kept; power that came on has left anything there. */
static void take_up(void) {
    cord_is_first_start = cord_kept.check != kept_check();
    if (cord_is_first_start) {
        cord_kept.latched = 0;
        cord_kept.boots = 0;
        cord_kept.recent_resets = 0;
    } else if (cord_kept.recent_resets < 255) {
        cord_kept.recent_resets++;
    }
    cord_kept.boots++;
    cord_kept_seal();
}

void cord_start(uint16_t moment) {
    cord_board_off();
    take_up();
    cord_now = 0;
    control_ms = 0;
    told_contacts = 0;
    cord_running = 0;
    cord_cleaning_forget();
    cord_arming_start();
    cord_motion_start();
    cord_session_start(cord_kept.boots * SEED_STEP ^ (uint32_t)moment << 16);
    cord_reflex_start(cord_kept.recent_resets >= CORD_RESET_RESETS_MAX);
    if (!cord_board_is_program_sound()) {
        cord_latch(CORD_INHIBIT_MEMORY);
        cord_inhibits_renew();
    }
    cord_transmit_start();
    told_inhibits = cord_inhibits;
}

uint16_t cord_flags(void) {
    uint16_t flags = cord_contacts & (CORD_BUMPERS | CORD_CLIFFS);
    if (cord_contacts & CORD_WHEEL_DROP) {
        flags |= 0x60;
    }
    /* No switch behind the dust box: it counts as in. */
    flags |= 0x80;
    return (uint16_t)(flags | (uint16_t)cord_running << 9);
}

/* Switches everything off and forgets all requests. */
static void stop_all(void) {
    cord_board_off();
    cord_duty[0] = cord_duty[1] = 0;
    cord_running = 0;
    cord_motion_halt();
    cord_cleaning_forget();
}

/* The same for who lost the permission: leases of another holder are void. */
static void void_permissions(void) {
    if (cord_is_moving()) {
        cord_arming_lose_link();
    }
    cord_arming_lock();
    stop_all();
    cord_inhibits_renew();
}

static uint8_t obey_drive(void) {
    if (cord_command.value > CORD_SPEED_MOST_UM_PER_S || cord_command.value < -CORD_SPEED_MOST_UM_PER_S ||
        cord_command.second > CORD_TURN_MOST_URAD_PER_S || cord_command.second < -CORD_TURN_MOST_URAD_PER_S) {
        return CORD_REFUSAL_RANGE;
    }
    cord_inhibits &= ~CORD_BIT(CORD_INHIBIT_LINK_LOST);
    if (!cord_arming_lets_move(cord_session) ||
        !cord_motion_drive(cord_command.value, cord_command.second, cord_command.lease_ms)) {
        cord_inhibits_renew();
        return CORD_REFUSAL_INHIBITED;
    }
    cord_arming_hear();
    return 0;
}

static uint8_t obey_motor(void) {
    uint8_t refusal;
    if (cord_command.what > CORD_MOTOR_WHEEL_RIGHT) {
        if (!cord_arming_lets_move(cord_session)) {
            return cord_command.what == CORD_MOTOR_BRUSH_LEFT || cord_command.what == CORD_MOTOR_BRUSH_RIGHT
                       ? CORD_REFUSAL_ABSENT
                       : CORD_REFUSAL_INHIBITED;
        }
        refusal = cord_cleaning_command(cord_command.what, cord_command.value, cord_command.lease_ms);
        if (refusal == 0) {
            cord_arming_renew();
        }
        return refusal;
    }
    cord_inhibits &= ~CORD_BIT(CORD_INHIBIT_LINK_LOST);
    if (!cord_arming_lets_move(cord_session) ||
        !cord_motion_direct(cord_command.what == CORD_MOTOR_WHEEL_RIGHT, (int16_t)(cord_command.value / DUTY_STEP),
                            cord_command.lease_ms)) {
        cord_inhibits_renew();
        return CORD_REFUSAL_INHIBITED;
    }
    cord_arming_hear();
    return 0;
}

static void obey_arm(void) {
    cord_motion_halt();
    cord_cleaning_forget();
    cord_arming_arm(cord_session);
    cord_inhibits_renew();
}

/* Carries out the command of the session; answers it as the protocol requires. */
static void obey(void) {
    uint8_t refusal = 0;
    switch (cord_command.name) {
    case CORD_COMMAND_DRIVE:
        refusal = obey_drive();
        break;
    case CORD_COMMAND_MOTOR:
        refusal = obey_motor();
        break;
    case CORD_COMMAND_STOP:
        cord_arming_stop();
        stop_all();
        cord_inhibits_renew();
        return;
    case CORD_COMMAND_INFO:
        cord_transmit_want_info();
        return;
    case CORD_COMMAND_STATE:
        cord_transmit_want_state();
        return;
    case CORD_COMMAND_ARM:
        obey_arm();
        break;
    case CORD_COMMAND_CLEAR:
        refusal = cord_latch_clear(cord_command.what);
        break;
    case CORD_COMMAND_SET:
        if (cord_command.what == CORD_PARAMETER_STATE_MS) {
            cord_transmit_set_state_ms((uint16_t)cord_command.value);
        } else {
            cord_transmit_set_info_ms((uint16_t)cord_command.value);
        }
        break;
    default:
        refusal = CORD_REFUSAL_ABSENT;
        break;
    }
    if (refusal == 0 && (cord_command.name == CORD_COMMAND_DRIVE || cord_command.name == CORD_COMMAND_MOTOR)) {
        return;
    }
    cord_session_answer(refusal);
}

static void dispatch(uint8_t event) {
    if (event == CORD_EVENT_COMMAND) {
        obey();
    } else if (event != CORD_EVENT_NONE) {
        void_permissions();
    }
}

/* True when it left nothing on the line. */
static uint8_t take_bytes(void) {
    uint8_t count;
    for (count = 0; count < BYTES_IN_PASS; count++) {
        switch (cord_board_receive()) {
        case CORD_RECEIVED_NOTHING:
            return 1;
        case CORD_RECEIVED_BYTE:
            cord_transmit_count_byte();
            dispatch(cord_session_take(cord_byte));
            break;
        case CORD_RECEIVED_FRAMING_ERROR:
            cord_session_framing_error();
            break;
        default:
            cord_session_overrun();
            break;
        }
    }
    return 0;
}

/* Tells the host what has changed. */
static void tell(void) {
    uint8_t changed = cord_contacts ^ told_contacts;
    uint8_t motor;
    if (cord_stalled != 0) {
        for (motor = 0; motor < 4; motor++) {
            if (cord_stalled & (1 << motor)) {
                cord_session_tell(CORD_FACT_STALL, motor);
            }
        }
        cord_stalled = 0;
    }
    if (changed != 0) {
        told_contacts = cord_contacts;
        if (changed & CORD_BUMPERS) {
            cord_session_tell(CORD_FACT_BUMP, cord_contacts);
        }
        if (changed & CORD_CLIFFS) {
            cord_session_tell(CORD_FACT_CLIFF, cord_contacts);
        }
        if (changed & CORD_WHEEL_DROP) {
            cord_session_tell(CORD_FACT_LIFT, cord_contacts);
        }
    }
    if (cord_inhibits != told_inhibits) {
        told_inhibits = cord_inhibits;
        cord_session_tell(CORD_FACT_INHIBITS, cord_inhibits);
    }
}

/* Everything that goes by the clock. */
static void tick(uint8_t elapsed_ms) {
    int8_t left = cord_motion_count(0, cord_board_edges(0), elapsed_ms);
    int8_t right = cord_motion_count(1, cord_board_edges(1), elapsed_ms);
    cord_now += elapsed_ms;
    if (cord_motion_expire(elapsed_ms)) {
        cord_arming_lose_link();
    }
    cord_cleaning_expire(elapsed_ms);
    cord_reflex_contacts(cord_board_contacts(), elapsed_ms, left, right);
    dispatch(cord_session_pass());
    if (cord_arming_pass(cord_session, elapsed_ms)) {
        stop_all();
    }
    control_ms += elapsed_ms;
    if (control_ms >= CONTROL_MS) {
        control_ms = (uint8_t)(control_ms >= 2 * CONTROL_MS ? 0 : control_ms - CONTROL_MS);
        cord_reflex_motors(cord_board_overloads());
        cord_motion_control();
        cord_transmit_tick(CONTROL_MS);
    }
    cord_inhibits_renew();
    cord_motion_apply();
    cord_cleaning_apply();
    tell();
    cord_board_feed();
}

void cord_pass(void) {
    uint8_t elapsed_ms = cord_board_elapsed_ms();
    cord_transmit_count_pass();
    if (elapsed_ms != 0) {
        tick(elapsed_ms);
    }
    /* What comes in can be lost, what goes out waits. */
    if (take_bytes()) {
        cord_transmit_pass();
    }
}

/* The reflexes S4, S6 to S13 and S15 of SAFETY.md, as far as the board has senses for them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "arming.h"
#include "board.h"
#include "cord.h"
#include "cordlib-rules.h"
#include "inhibit.h"
#include "machine.h"
#include "motion.h"
#include "port.h"

#define CONTACTS 7
/* Duty above which a motor must turn, of 255. */
#define HARD_DUTY (CORD_STALL_STALL_DUTY_MILLIONTHS / 3922)
#define REVERSE_COUNTS (CORD_CLIFF_REVERSE_MAX_NM / 1000 / CORD_COUNT_UM)
#define BACKING_COUNTS (CORD_BUMPER_STUCK_BACKING_NM / 1000 / CORD_COUNT_UM)
#define PROGRESS_COUNTS (CORD_PROGRESS_PROGRESS_MIN_NM / 1000 / CORD_COUNT_UM)
/* Speeds in micrometres of a control period of 10 ms. */
#define SLACK (CORD_RUNAWAY_SLACK_UM_PER_S / 100)
#define SET_POINT_LEAST (CORD_ENCODER_SET_POINT_MIN_UM_PER_S / 100)
/* The line of the battery must complain for so long. */
#define PERIOD_MS 10
#define LONGEST_MS 60000U

CORD_NEAR uint32_t cord_inhibits;
CORD_NEAR uint8_t cord_contacts;
uint8_t cord_stalled;

/* How long a contact must differ to count, and to count no more. */
static const uint8_t set_ms[CONTACTS] = {0, 0, CORD_CLIFF_SET_MS, CORD_CLIFF_SET_MS, CORD_CLIFF_SET_MS, CORD_LIFT_SET_MS,
                                         CORD_LIFT_SET_MS};
static const uint8_t clear_ms[CONTACTS] = {CORD_BUMPER_RELEASE_MS, CORD_BUMPER_RELEASE_MS, CORD_CLIFF_CLEAR_MS,
                                           CORD_CLIFF_CLEAR_MS,    CORD_CLIFF_CLEAR_MS,    CORD_LIFT_CLEAR_MS,
                                           CORD_CLIFF_CLEAR_MS};
/* Milliseconds for which a contact has differed, plus one; 0 if it does not. */
static uint8_t differs_ms[CONTACTS];
static CORD_NEAR uint8_t any_differs;

static uint8_t is_lifted;
static uint16_t grounded_ms;
static uint16_t pressed_ms;
static uint16_t backing_ms;
/* Twice the distance in counts: the sum of both wheels. */
static int16_t backed;
static int16_t reversed;
/* Ages of the last three onsets of a cliff; LONGEST_MS = none. */
static uint16_t onset_ms[CORD_CLIFF_ONSETS_MAX];
static uint8_t is_idle;
static uint16_t rest_ms;
static int16_t headway[2];
static uint16_t young_ms;

/* Control periods for which something has held. */
enum timer { TIMER_OVER = 0, TIMER_STILL = 4, TIMER_RUNAWAY = 6, TIMER_ENCODER = 8, TIMER_WINDOW = 10, TIMERS = 11 };
static uint8_t held[TIMERS];
static uint16_t battery_ms;
static uint8_t is_watched;

static void add_ms(uint16_t *time_ms, uint8_t elapsed_ms) {
    if (*time_ms < LONGEST_MS) {
        *time_ms += elapsed_ms;
    }
}

/* Lets a timer run while something holds; true once it has held for so many periods, when it begins anew. */
static uint8_t holds(uint8_t timer, uint8_t condition, uint8_t periods) {
    if (!condition) {
        held[timer] = 0;
        return 0;
    }
    held[timer]++;
    if (held[timer] <= periods) {
        return 0;
    }
    held[timer] = 0;
    return 1;
}

void cord_reflex_start(uint8_t is_reset_loop) {
    uint8_t index;
    cord_contacts = 0;
    cord_stalled = 0;
    any_differs = 0;
    is_lifted = 0;
    grounded_ms = pressed_ms = backing_ms = rest_ms = young_ms = battery_ms = 0;
    backed = reversed = 0;
    is_idle = 0;
    is_watched = 0;
    for (index = 0; index < CONTACTS; index++) {
        differs_ms[index] = 0;
    }
    for (index = 0; index < CORD_CLIFF_ONSETS_MAX; index++) {
        onset_ms[index] = LONGEST_MS;
    }
    for (index = 0; index < TIMERS; index++) {
        held[index] = 0;
    }
    headway[0] = headway[1] = 0;
    if (is_reset_loop) {
        cord_latch(CORD_INHIBIT_RESET_LOOP);
    }
    cord_inhibits_renew();
}

/* Debounces: most passes have nothing to do. */
static void settle(uint8_t raw, uint8_t elapsed_ms) {
    uint8_t differs = raw ^ cord_contacts;
    uint8_t index;
    uint8_t bit;
    if ((differs | any_differs) == 0) {
        return;
    }
    any_differs = differs;
    for (index = 0, bit = 1; index < CONTACTS; index++, bit = (uint8_t)(bit << 1)) {
        uint8_t span_ms;
        if ((differs & bit) == 0) {
            differs_ms[index] = 0;
            continue;
        }
        if (differs_ms[index] == 0) {
            differs_ms[index] = 1;
        } else {
            differs_ms[index] = (uint8_t)(differs_ms[index] > 200 - elapsed_ms ? 200 : differs_ms[index] + elapsed_ms);
        }
        span_ms = (raw & bit) ? set_ms[index] : clear_ms[index];
        if (differs_ms[index] > span_ms) {
            cord_contacts ^= bit;
            differs_ms[index] = 0;
        }
    }
}

static void judge_bumper(uint8_t elapsed_ms, int8_t travelled) {
    uint8_t is_backing = cord_duty[0] + cord_duty[1] < 0;
    if (travelled > 0 || ((cord_contacts & CORD_BUMPERS) && is_backing)) {
        backed -= travelled;
        if (backed < 0) {
            backed = 0;
        }
    }
    if ((cord_contacts & CORD_BUMPERS) == 0) {
        pressed_ms = 0;
        backing_ms = 0;
        return;
    }
    /* A robot that nobody may move may stand against a wall. */
    if (cord_arming_state() == CORD_ARMING_LOCKED) {
        pressed_ms = 0;
    } else {
        add_ms(&pressed_ms, elapsed_ms);
    }
    if (is_backing) {
        add_ms(&backing_ms, elapsed_ms);
    } else {
        backing_ms = 0;
    }
    if (pressed_ms >= CORD_BUMPER_STUCK_MS || backing_ms >= CORD_BUMPER_STUCK_BACKING_MS ||
        backed > 2 * BACKING_COUNTS) {
        cord_latch(CORD_INHIBIT_BUMPER_STUCK);
    }
}

/* Notes an onset; true if it is the third within the window. */
static uint8_t is_trapping_onset(void) {
    uint8_t index;
    uint8_t known = 0;
    uint8_t is_noted = 0;
    for (index = 0; index < CORD_CLIFF_ONSETS_MAX; index++) {
        if (onset_ms[index] <= CORD_CLIFF_ONSETS_WINDOW_MS) {
            known++;
        } else if (!is_noted) {
            onset_ms[index] = 0;
            is_noted = 1;
            known++;
        }
    }
    if (known < CORD_CLIFF_ONSETS_MAX) {
        return 0;
    }
    for (index = 0; index < CORD_CLIFF_ONSETS_MAX; index++) {
        onset_ms[index] = LONGEST_MS;
    }
    return 1;
}

/* Whether an onset now belongs to the last cliff. */
static uint8_t is_same_cliff(void) {
    uint8_t index;
    for (index = 0; index < CORD_CLIFF_ONSETS_MAX; index++) {
        if (onset_ms[index] <= CORD_CLIFF_SAME_CLIFF_MS) {
            return 1;
        }
    }
    return 0;
}

static void judge_cliff(uint8_t had_cliff, int8_t travelled) {
    if (!had_cliff && !is_same_cliff()) {
        reversed = 0;
        if ((cord_duty[0] | cord_duty[1]) != 0 && is_trapping_onset()) {
            cord_latch(CORD_INHIBIT_CLIFF_TRAPPED);
        }
    }
    reversed -= travelled;
    if (reversed < 0) {
        reversed = 0;
    }
    if (reversed > 2 * REVERSE_COUNTS) {
        cord_latch(CORD_INHIBIT_CLIFF_TRAPPED);
    }
}

void cord_reflex_contacts(uint8_t raw, uint8_t elapsed_ms, int8_t left, int8_t right) {
    uint8_t had_cliff = cord_contacts & CORD_CLIFFS;
    int8_t travelled = (int8_t)(left + right);
    settle(raw, elapsed_ms);
    if (travelled > 0 || (cord_contacts & CORD_BUMPERS) || pressed_ms != 0) {
        judge_bumper(elapsed_ms, travelled);
    }
    if (cord_contacts & CORD_CLIFFS) {
        judge_cliff(had_cliff, travelled);
    }
    if (cord_contacts & CORD_WHEEL_DROP) {
        is_lifted = 1;
        grounded_ms = 0;
    } else if (is_lifted) {
        add_ms(&grounded_ms, elapsed_ms);
        is_lifted = grounded_ms < CORD_LIFT_GROUNDED_MS;
    }
}

static void judge_overloads(uint8_t overloads) {
    static const uint8_t latches[4] = {CORD_INHIBIT_WHEEL_STALL, CORD_INHIBIT_WHEEL_STALL, CORD_INHIBIT_BRUSH_STALL,
                                       CORD_INHIBIT_BRUSH_STALL};
    uint8_t index;
    for (index = 0; index < 4; index++) {
        if (holds(TIMER_OVER + index, overloads & 1, CORD_STALL_OVER_CURRENT_MS / PERIOD_MS)) {
            cord_stalled |= (uint8_t)(1 << index);
            cord_latch(latches[index]);
        }
        overloads >>= 1;
    }
}

static int16_t magnitude(int16_t value) {
    return value < 0 ? (int16_t)-value : value;
}

static void judge_wheel(uint8_t side) {
    int16_t speed = magnitude(cord_speed[side]);
    int16_t goal = magnitude(cord_set_point[side]);
    uint8_t is_driven = cord_duty[side] != 0;
    uint8_t is_still = magnitude(cord_duty[side]) > HARD_DUTY && cord_period_counts[side] == 0;
    /* Goals are below 1 m/s: half as much again and a count fit into 16 bits. */
    int16_t most = (int16_t)(goal + (goal >> 1) + SLACK + CORD_COUNT_UM);
    /* Up to two periods late by the rule's own count, and a third because a period on this chip may begin late. */
    if (holds(TIMER_STILL + side, is_still, CORD_STALL_STANDSTILL_MS / PERIOD_MS - 1)) {
        cord_stalled |= (uint8_t)(1 << side);
        cord_latch(CORD_INHIBIT_WHEEL_STALL);
    }
    if (cord_is_direct()) {
        held[TIMER_RUNAWAY + side] = held[TIMER_ENCODER + side] = 0;
        return;
    }
    if (holds(TIMER_RUNAWAY + side, speed > most, CORD_RUNAWAY_RUNAWAY_MS / PERIOD_MS) && is_watched) {
        cord_latch(CORD_INHIBIT_RUNAWAY);
    }
    if (holds(TIMER_ENCODER + side, is_driven && goal >= SET_POINT_LEAST && speed < goal && 5 * (speed + 1) <= goal,
              CORD_ENCODER_DISAGREEMENT_MS / PERIOD_MS)) {
        cord_latch(CORD_INHIBIT_ENCODER);
    }
}

static void judge_progress(void) {
    if (is_idle) {
        add_ms(&rest_ms, PERIOD_MS);
        is_idle = rest_ms < CORD_PROGRESS_REST_MS;
    }
    if (magnitude(cord_duty[0]) < HARD_DUTY && magnitude(cord_duty[1]) < HARD_DUTY) {
        held[TIMER_WINDOW] = 0;
        headway[0] = headway[1] = 0;
        return;
    }
    headway[0] += cord_period_counts[0];
    headway[1] += cord_period_counts[1];
    if (magnitude(headway[0]) >= PROGRESS_COUNTS || magnitude(headway[1]) >= PROGRESS_COUNTS) {
        held[TIMER_WINDOW] = 0;
        headway[0] = headway[1] = 0;
    } else if (holds(TIMER_WINDOW, 1, CORD_PROGRESS_WINDOW_MS / PERIOD_MS)) {
        is_idle = 1;
        rest_ms = 0;
    }
}

/* Times that need no better resolution than a control period. */
static void age(void) {
    uint8_t index;
    for (index = 0; index < CORD_CLIFF_ONSETS_MAX; index++) {
        add_ms(&onset_ms[index], PERIOD_MS);
    }
    if (young_ms < LONGEST_MS) {
        add_ms(&young_ms, PERIOD_MS);
        if (young_ms >= CORD_RESET_SOUND_MS) {
            cord_forget_resets();
        }
    }
}

void cord_reflex_motors(uint8_t overloads) {
    uint8_t turns = magnitude(cord_speed[0]) > CORD_COUNT_UM || magnitude(cord_speed[1]) > CORD_COUNT_UM;
    age();
    is_watched = cord_arming_state() != CORD_ARMING_LOCKED || (is_watched && turns);
    if (!is_lifted) {
        judge_overloads(overloads);
        judge_wheel(0);
        judge_wheel(1);
        judge_progress();
    }
    if (cord_board_is_battery_low()) {
        add_ms(&battery_ms, PERIOD_MS);
    } else {
        battery_ms = 0;
    }
}

void cord_latch(uint8_t inhibit) {
    uint32_t bit = CORD_BIT(inhibit);
    if ((cord_kept.latched & bit) == 0) {
        cord_kept.latched |= bit;
        cord_kept_seal();
    }
}

static uint8_t cause_remains(uint8_t inhibit) {
    switch (inhibit) {
    case CORD_INHIBIT_RESET_LOOP:
        return young_ms < CORD_RESET_SOUND_MS;
    case CORD_INHIBIT_BUMPER_STUCK:
        return cord_contacts & CORD_BUMPERS;
    case CORD_INHIBIT_CLIFF_TRAPPED:
        return cord_contacts & CORD_CLIFFS;
    case CORD_INHIBIT_RUNAWAY:
        return magnitude(cord_speed[0]) > CORD_COUNT_UM || magnitude(cord_speed[1]) > CORD_COUNT_UM;
    case CORD_INHIBIT_WHEEL_STALL:
        return cord_board_overloads() & (CORD_LOAD_LEFT | CORD_LOAD_RIGHT);
    case CORD_INHIBIT_BRUSH_STALL:
        return cord_board_overloads() & (CORD_LOAD_BRUSH | CORD_LOAD_SUCTION);
    case CORD_INHIBIT_MEMORY:
        return 1; /* until the next check, after power was off */
    default:
        return 0;
    }
}

uint8_t cord_latch_clear(uint8_t inhibit) {
    uint32_t bit = CORD_BIT(inhibit);
    if ((cord_kept.latched & bit) == 0) {
        return 0;
    }
    if (cause_remains(inhibit)) {
        return CORD_REFUSAL_CAUSE_REMAINS;
    }
    if (inhibit == CORD_INHIBIT_BUMPER_STUCK) {
        backed = 0;
    }
    cord_kept.latched &= ~bit;
    cord_kept_seal();
    cord_inhibits_renew();
    return 0;
}

void cord_inhibits_renew(void) {
    cord_inhibits = cord_kept.latched | cord_arming_inhibits();
    if (cord_contacts & CORD_BUMPERS) {
        cord_inhibits |= CORD_BIT(CORD_INHIBIT_BUMPER);
    }
    if (cord_contacts & CORD_CLIFFS) {
        cord_inhibits |= CORD_BIT(CORD_INHIBIT_CLIFF);
    }
    if (cord_contacts & CORD_CLIFF_BLIND) {
        cord_inhibits |= CORD_BIT(CORD_INHIBIT_CLIFF_SENSOR);
    }
    if (is_lifted) {
        cord_inhibits |= CORD_BIT(CORD_INHIBIT_WHEEL_DROP);
    }
    if (is_idle) {
        cord_inhibits |= CORD_BIT(CORD_INHIBIT_NOT_MOVING);
    }
    if (battery_ms >= CORD_BATTERY_LOW_MS) {
        cord_inhibits |= CORD_BIT(CORD_INHIBIT_BATTERY_LOW);
    }
}

uint8_t cord_sees_cliff(void) {
    return (cord_contacts & (CORD_CLIFFS | CORD_CLIFF_BLIND)) != 0;
}

uint8_t cord_inhibits_forward(void) {
    return (cord_contacts & (CORD_CLIFFS | CORD_CLIFF_BLIND | CORD_BUMPERS)) != 0;
}

/* Whether a motion leads away from the pressed side of the bumper. */
static uint8_t is_away(int16_t left, int16_t right) {
    uint8_t pressed = cord_contacts & CORD_BUMPERS;
    if (left <= 0 && right <= 0) {
        return 1;
    }
    if (left >= 0 && right <= 0) {
        return pressed == CORD_BUMPER_LEFT;
    }
    return left <= 0 && right >= 0 && pressed == CORD_BUMPER_RIGHT;
}

uint8_t cord_permits(int16_t left, int16_t right) {
    if (left == 0 && right == 0) {
        return 1;
    }
    if ((cord_inhibits & ~CORD_WHEELS_MAY_RUN) != 0) {
        return 0;
    }
    if (cord_sees_cliff() && (left > 0 || right > 0)) {
        return 0;
    }
    return (cord_contacts & CORD_BUMPERS) == 0 || is_away(left, right);
}

uint8_t cord_permits_cleaners(void) {
    return (cord_inhibits & ~CORD_CLEANERS_MAY_RUN) == 0;
}

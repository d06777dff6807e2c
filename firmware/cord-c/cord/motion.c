/* Wheels under their leases. The controller of a wheel is that of the Rust cord in 16 bits: feed-forward over the dead band, the
 * speed error, and the position lag, which is exact to the count and never drifts.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "motion.h"
#include "arming.h"
#include "board.h"
#include "cordlib-rules.h"
#include "inhibit.h"
#include "machine.h"
#include "port.h"

/* After a reversal a wheel first keeps its old direction: its edges are not counted for so long. */
#define REVERSAL_MS 100
/* Ramps of a period: 0.5 m/s^2 and 4 rad/s^2. */
#define RAMP_SPEED 50
#define RAMP_TURN 40
/* What a wheel that was blocked may catch up, in micrometres. */
#define LAG_MOST 15000
/* Most that a duty changes in a period. */
#define SLEW 13
/* Least duty at which a motor turns. */
#define DEAD_BAND 26
#define FULL 255
#define FULL_SPEED (CORD_FULL_SPEED_UM_PER_S / 100)
/* Feed-forward, proportional and integral gain in duty for a unit, times 2^12, 2^12 and 2^16: 1.5 thousandths of full for a mm/s,
 * 15 thousandths for a mm. Each fits into a byte, as `scaled` wants it. */
#define FORWARD ((FULL - DEAD_BAND) * 4096L / FULL_SPEED)
#define PROPORTIONAL 157
#define INTEGRAL 251
/* Beside an edge the speed is a limit: a lag adds no more than this. */
#define LAG_DUTY_MOST 13
#define EDGE_SPEED (CORD_CLIFF_SPEED_MAX_UM_PER_S / 100)
#define EDGE_FASTEST ((CORD_CLIFF_SPEED_MAX_UM_PER_S + CORD_CLIFF_SPEED_RIPPLE_UM_PER_S) / 100)
/* A wheel that turns faster is braked before a duty drives it the other way. */
#define REVERSAL_SPEED 500
/* Rim speed for a mrad/s: whole ones, and 256ths. */
#define SWING_WHOLE (CORD_HALF_TRACK_UM / 100000L)
#define SWING_PARTS (CORD_HALF_TRACK_UM % 100000L * 256L / 100000L)
/* More edges than this in a period are no wheel's. */
#define COUNTS_MOST 6

CORD_NEAR int16_t cord_duty[2];
CORD_NEAR int16_t cord_speed[2];
int16_t cord_set_point[2];
int8_t cord_period_counts[2];
int32_t cord_total[2];

static CORD_NEAR uint8_t phase;
static uint8_t was_braked;
static uint16_t lease_ms[2];
static int16_t target_speed, target_turn;
/* Rims of the target: what a permit is asked for. */
static int16_t target_rims[2];
static int16_t now_speed, now_turn;
static int16_t direct[2];
/* Duty that is asked for. */
static CORD_NEAR int16_t asked[2];
static CORD_NEAR int16_t lag[2];
/* Last direction that was driven: 1, -1, 0 before the first. */
static int8_t direction[2];
static CORD_NEAR uint8_t unsure_ms[2];
static CORD_NEAR int8_t counted[2];

/* Rims of a velocity, by `set_rims`. */
static CORD_NEAR int16_t rims[2];

void cord_motion_start(void) {
    uint8_t side;
    for (side = 0; side < 2; side++) {
        cord_speed[side] = 0;
        cord_period_counts[side] = 0;
        cord_total[side] = 0;
        direction[side] = 0;
        unsure_ms[side] = 0;
        counted[side] = 0;
        cord_duty[side] = 0;
    }
    cord_motion_halt();
}

void cord_motion_halt(void) {
    uint8_t side;
    phase = CORD_PHASE_IDLE;
    was_braked = 0;
    target_speed = target_turn = now_speed = now_turn = 0;
    for (side = 0; side < 2; side++) {
        lease_ms[side] = 0;
        direct[side] = 0;
        asked[side] = 0;
        lag[side] = 0;
        cord_set_point[side] = 0;
    }
}

uint8_t cord_phase(void) {
    return phase == CORD_PHASE_IDLE && was_braked ? CORD_PHASE_REFLEX : phase;
}

uint8_t cord_is_direct(void) {
    return phase == CORD_PHASE_MOTOR;
}

uint8_t cord_is_moving(void) {
    return phase != CORD_PHASE_IDLE;
}

int8_t cord_motion_count(uint8_t side, uint8_t edges, uint8_t elapsed_ms) {
    int8_t signed_edges;
    if (unsure_ms[side] != 0) {
        unsure_ms[side] = (uint8_t)(unsure_ms[side] > elapsed_ms ? unsure_ms[side] - elapsed_ms : 0);
        return 0;
    }
    if (edges == 0) {
        return 0;
    }
    if (edges > COUNTS_MOST) {
        edges = COUNTS_MOST;
    }
    signed_edges = direction[side] < 0 ? (int8_t)-edges : (int8_t)edges;
    cord_total[side] += signed_edges;
    counted[side] += signed_edges;
    return signed_edges;
}

/* A value times a 256th of a byte, rounded towards 0: two short products, for chips that have no long one. */
static int16_t scaled(int16_t value, uint8_t factor) {
    uint16_t size = (uint16_t)(value < 0 ? -value : value);
    uint16_t low = (uint16_t)((uint8_t)size * factor);
    size = (uint16_t)((uint16_t)((uint8_t)(size >> 8) * factor) + (low >> 8));
    return value < 0 ? (int16_t)-(int16_t)size : (int16_t)size;
}

/* Rims of a base that moves so, no faster than `most`, with the same curvature. */
static void set_rims(int16_t speed, int16_t turn, int16_t most) {
    int16_t swing = (int16_t)(turn * SWING_WHOLE + scaled(turn, SWING_PARTS));
    int16_t fastest;
    uint8_t side;
    rims[0] = speed - swing;
    rims[1] = speed + swing;
    fastest = speed < 0 ? (int16_t)-speed : speed;
    fastest = (int16_t)(fastest + (swing < 0 ? -swing : swing));
    if (fastest > most) {
        for (side = 0; side < 2; side++) {
            rims[side] = (int16_t)((int32_t)rims[side] * most / fastest);
        }
    }
}

static uint8_t suits_base(int16_t speed, int16_t left, int16_t right) {
    return !(cord_inhibits_forward() && speed > 0) && cord_permits(left, right);
}

/* A value over 2^(16 + shift) / factor, rounded towards 0: a division by another name, in a fifth of its time. */
static int16_t divided(int32_t value, uint16_t factor, uint8_t shift) {
    uint32_t size = (uint32_t)(value < 0 ? -value : value);
    int16_t quotient = (int16_t)((uint16_t)(size * factor >> 16) >> shift);
    return value < 0 ? (int16_t)-quotient : quotient;
}

uint8_t cord_motion_drive(int32_t um_per_s, int32_t urad_per_s, uint16_t lease) {
    int16_t speed = divided(um_per_s, 5243, 3);   /* 100 */
    int16_t turn = divided(urad_per_s, 1049, 4); /* 1000 */
    set_rims(speed, turn, FULL_SPEED);
    if (!suits_base(speed, rims[0], rims[1])) {
        return 0;
    }
    target_rims[0] = rims[0];
    target_rims[1] = rims[1];
    if (phase != CORD_PHASE_DRIVE) {
        cord_motion_halt();
        phase = CORD_PHASE_DRIVE;
    }
    target_speed = speed;
    target_turn = turn;
    lease_ms[0] = lease;
    return 1;
}

uint8_t cord_motion_direct(uint8_t side, int16_t duty, uint16_t lease) {
    if (!cord_permits(side == 0 ? duty : 0, side == 0 ? 0 : duty)) {
        return 0;
    }
    if (phase != CORD_PHASE_MOTOR) {
        cord_motion_halt();
        phase = CORD_PHASE_MOTOR;
    }
    direct[side] = duty;
    lease_ms[side] = lease;
    return 1;
}

/* Whether a lease ends now. */
static uint8_t ends(uint8_t side, uint8_t elapsed_ms) {
    if (lease_ms[side] == 0) {
        return 0;
    }
    if (lease_ms[side] > elapsed_ms) {
        lease_ms[side] -= elapsed_ms;
        return 0;
    }
    lease_ms[side] = 0;
    return 1;
}

uint8_t cord_motion_expire(uint8_t elapsed_ms) {
    uint8_t is_lost = 0;
    uint8_t side;
    if (phase == CORD_PHASE_DRIVE) {
        if (ends(0, elapsed_ms)) {
            is_lost = (target_speed | target_turn | now_speed | now_turn) != 0;
            cord_motion_halt();
        }
    } else if (phase == CORD_PHASE_MOTOR) {
        for (side = 0; side < 2; side++) {
            if (ends(side, elapsed_ms)) {
                is_lost |= direct[side] != 0;
                direct[side] = 0;
            }
        }
        if ((lease_ms[0] | lease_ms[1]) == 0) {
            cord_motion_halt();
        }
    }
    return is_lost;
}

static int16_t within(int16_t value, int16_t least, int16_t most) {
    if (value < least) {
        return least;
    }
    return value > most ? most : value;
}

/* One step of a duty. The dead band is skipped, because no motor turns in it. */
static int16_t slew(int16_t from, int16_t wanted) {
    if (from == 0 || (from ^ wanted) < 0) {
        from = wanted < 0 ? -DEAD_BAND : DEAD_BAND;
    }
    return within(wanted, from - SLEW, from + SLEW);
}

static void measure(uint8_t side) {
    int16_t sample = (int16_t)(counted[side] * CORD_COUNT_UM);
    int16_t change = sample - cord_speed[side];
    cord_period_counts[side] = counted[side];
    counted[side] = 0;
    cord_speed[side] = (int16_t)(cord_speed[side] + (change > -4 && change < 4 ? change : scaled(change, 64)));
    lag[side] = within((int16_t)within(lag[side], -LAG_MOST, LAG_MOST) - (int16_t)within(sample, -LAG_MOST, LAG_MOST),
                       -LAG_MOST, LAG_MOST);
}

/* A wheel under speed control: forward in the direction of its set point, or brake. */
static void control_wheel(uint8_t side, int16_t speed, uint8_t near_edge) {
    int16_t duty;
    int16_t of_lag;
    cord_set_point[side] = speed;
    if (speed == 0) {
        asked[side] = 0;
        return;
    }
    lag[side] = within((int16_t)(lag[side] + speed), -LAG_MOST, LAG_MOST);
    of_lag = scaled(lag[side], INTEGRAL) >> 8;
    if (near_edge) {
        of_lag = within(of_lag, -LAG_DUTY_MOST, LAG_DUTY_MOST);
    }
    duty = (int16_t)(((scaled(speed, FORWARD) + scaled((int16_t)(speed - cord_speed[side]), PROPORTIONAL)) >> 4) + of_lag);
    if (duty == 0 || (duty ^ speed) < 0) {
        asked[side] = 0;
        return;
    }
    duty = within((int16_t)(duty + (speed < 0 ? -DEAD_BAND : DEAD_BAND)), -FULL, FULL);
    asked[side] = slew(asked[side], duty);
}

static int16_t approach(int16_t from, int16_t to, int16_t step) {
    return within(to, from - step, from + step);
}

static void control_drive(void) {
    uint8_t near_edge = cord_sees_cliff();
    uint8_t side;
    now_speed = approach(now_speed, target_speed, RAMP_SPEED);
    now_turn = approach(now_turn, target_turn, RAMP_TURN);
    set_rims(now_speed, now_turn, near_edge ? EDGE_SPEED : FULL_SPEED);
    for (side = 0; side < 2; side++) {
        if ((now_speed | now_turn) == 0) {
            lag[side] = 0;
        }
        control_wheel(side, rims[side], near_edge);
    }
}

/* A duty as it was commanded; beside an edge a speed of that direction, as fast as is allowed there. */
static void control_direct(uint8_t side) {
    int16_t duty = direct[side];
    if (cord_sees_cliff() && duty != 0) {
        int16_t speed = (int16_t)within((int16_t)((int32_t)duty * FULL_SPEED / FULL), -EDGE_SPEED, EDGE_SPEED);
        control_wheel(side, speed, 1);
        return;
    }
    cord_set_point[side] = 0;
    lag[side] = 0;
    if (duty == 0 || (duty > 0 ? cord_speed[side] < -REVERSAL_SPEED : cord_speed[side] > REVERSAL_SPEED)) {
        asked[side] = 0;
    } else {
        asked[side] = slew(asked[side], duty);
    }
}

void cord_motion_control(void) {
    measure(0);
    measure(1);
    if (phase == CORD_PHASE_DRIVE) {
        control_drive();
    } else if (phase == CORD_PHASE_MOTOR) {
        control_direct(0);
        control_direct(1);
    }
}

static uint8_t suits(void) {
    if (phase == CORD_PHASE_DRIVE) {
        return suits_base(target_speed, target_rims[0], target_rims[1]);
    }
    return phase != CORD_PHASE_MOTOR || cord_permits(direct[0], direct[1]);
}

/* Takes from `rims`, which hold duties here, what is not permitted: the gate. */
static void restrict_to_permit(void) {
    uint8_t side;
    if (cord_arming_state() == CORD_ARMING_LOCKED || (lease_ms[0] | lease_ms[1]) == 0 || !cord_permits(rims[0], rims[1])) {
        rims[0] = rims[1] = 0;
        return;
    }
    if (!cord_inhibits_forward()) {
        return;
    }
    for (side = 0; side < 2; side++) {
        int16_t other = (int16_t)-rims[1 - side];
        /* Beside an obstacle no wheel drives ahead faster than the other backs off. */
        if (rims[side] > 0 && rims[side] > other) {
            rims[side] = other;
        }
        if (cord_sees_cliff() && cord_speed[side] < -EDGE_FASTEST) {
            rims[side] = 0;
        }
    }
}

static void apply_wheel(uint8_t side, int16_t duty) {
    int8_t now = duty > 0 ? 1 : duty < 0 ? -1 : 0;
    if (now != 0 && now != direction[side]) {
        if (direction[side] != 0) {
            unsure_ms[side] = REVERSAL_MS;
        }
        direction[side] = now;
    }
    cord_duty[side] = duty;
}

void cord_motion_apply(void) {
    uint8_t side;
    uint8_t is_changed = 0;
    if (phase != CORD_PHASE_IDLE && !suits()) {
        cord_motion_halt();
        was_braked = 1;
    }
    rims[0] = asked[0];
    rims[1] = asked[1];
    restrict_to_permit();
    for (side = 0; side < 2; side++) {
        if (rims[side] != cord_duty[side]) {
            apply_wheel(side, rims[side]);
            is_changed = 1;
        }
    }
    if (is_changed) {
        cord_board_drive();
    }
}

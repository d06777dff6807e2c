/* Wheels under their leases: speed control from encoders with one line, whose sign is that of the commanded direction.
 *
 * Speeds are micrometres of a control period of 10 ms, which is 0.1 mm/s; turn rates are mrad/s; duties -255..255.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORD_MOTION_H
#define CORD_MOTION_H

#include "port.h"
#include <stdint.h>

enum cord_phase { CORD_PHASE_IDLE, CORD_PHASE_DRIVE, CORD_PHASE_MOVE, CORD_PHASE_MOTOR, CORD_PHASE_REFLEX };

/* By wheel, 0 left, 1 right: what is applied, the filtered speed, the set point, edges of the last period, totals. */
extern CORD_NEAR int16_t cord_duty[2];
extern CORD_NEAR int16_t cord_speed[2];
extern int16_t cord_set_point[2];
extern int8_t cord_period_counts[2];
extern int32_t cord_total[2];

void cord_motion_start(void);
/* Counts of this pass, with their sign. */
int8_t cord_motion_count(uint8_t side, uint8_t edges, uint8_t elapsed_ms);
/* Drives the base; the values of `drive`. False if the reflexes forbid it. */
uint8_t cord_motion_drive(int32_t um_per_s, int32_t urad_per_s, uint16_t lease_ms);
/* Drives one wheel directly, -255..255. */
uint8_t cord_motion_direct(uint8_t side, int16_t duty, uint16_t lease_ms);
/* Ends leases that are over; true if that stopped something. */
uint8_t cord_motion_expire(uint8_t elapsed_ms);
/* One control period of 10 ms. */
void cord_motion_control(void);
/* Lets through what is permitted, and drives the wheels. */
void cord_motion_apply(void);
/* Drops all requests. */
void cord_motion_halt(void);
uint8_t cord_phase(void);
uint8_t cord_is_direct(void);
uint8_t cord_is_moving(void);

#endif

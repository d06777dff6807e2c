/* Brush, side brush and suction: leases, and the rule S29 for their start.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORD_CLEANING_H
#define CORD_CLEANING_H

#include <stdint.h>

/* Motors that run, bits: main brush, side brushes, suction. */
extern uint8_t cord_running;

void cord_cleaning_forget(void);
/* A command for one of them; 0, or why it is refused. */
uint8_t cord_cleaning_command(uint8_t motor, int32_t throttle, uint16_t lease_ms);
void cord_cleaning_expire(uint8_t elapsed_ms);
/* Lets through what is permitted. */
void cord_cleaning_apply(void);

#endif

/* What keeps the robot from moving, and the one gate between requests and motors.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORD_INHIBIT_H
#define CORD_INHIBIT_H

#include "wire.h"
#include "port.h"
#include <stdint.h>

#define CORD_BIT(inhibit) ((uint32_t)1 << (inhibit))

/* What forbids nothing, or only some directions. */
#define CORD_ESCAPABLE \
    (CORD_BIT(CORD_INHIBIT_BUMPER) | CORD_BIT(CORD_INHIBIT_CLIFF) | CORD_BIT(CORD_INHIBIT_CLIFF_SENSOR))
#define CORD_WHEELS_MAY_RUN (CORD_ESCAPABLE | CORD_BIT(CORD_INHIBIT_BATTERY_LOW))
#define CORD_CLEANERS_MAY_RUN                                                                     \
    (CORD_ESCAPABLE | CORD_BIT(CORD_INHIBIT_BATTERY_LOW) | CORD_BIT(CORD_INHIBIT_LINK_LOST) |      \
     CORD_BIT(CORD_INHIBIT_NOT_MOVING))

/* Starts the rules with what was latched before a reset. */
void cord_reflex_start(uint8_t is_reset_loop);
/* Rules on contacts and floor, in every pass. Counts: edges of the pass with their sign. */
void cord_reflex_contacts(uint8_t raw, uint8_t elapsed_ms, int8_t left, int8_t right);
/* Rules on motors, every 10 ms. */
void cord_reflex_motors(uint8_t overloads);
/* Everything that inhibits now; kept until the next pass or change. */
extern CORD_NEAR uint32_t cord_inhibits;
void cord_inhibits_renew(void);
/* Contacts that count, after debouncing; CORD_WHEEL_DROP without its hold of a second. */
extern CORD_NEAR uint8_t cord_contacts;
void cord_latch(uint8_t inhibit);
/* Clears a latch; 0, or why it is refused. */
uint8_t cord_latch_clear(uint8_t inhibit);
/* Motors whose stall is to be told, CORD_LOAD_LEFT and so on. */
extern uint8_t cord_stalled;

uint8_t cord_sees_cliff(void);
uint8_t cord_inhibits_forward(void);
/* Whether wheels may turn in these directions. */
uint8_t cord_permits(int16_t left, int16_t right);
uint8_t cord_permits_cleaners(void);

#endif

/* Who may move the robot: SPEC.md, section 4, for a robot without a dock.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORD_ARMING_H
#define CORD_ARMING_H

#include <stdint.h>

/* Holder: 0 a person who types, else the number of a session. */
void cord_arming_start(void);
/* Allows motion; ends `stopped` and `link-lost`. */
void cord_arming_arm(uint16_t holder);
/* Somebody said `stop`. */
void cord_arming_stop(void);
/* Ends any permission. */
void cord_arming_lock(void);
/* The state, CORD_ARMING_... */
uint8_t cord_arming_state(void);
uint8_t cord_arming_lets_move(uint16_t holder);
/* A motion command was accepted. */
void cord_arming_renew(void);
/* A lease of something that moved has ended; ends with the next wheel command. */
void cord_arming_lose_link(void);
void cord_arming_hear(void);
/* Lets time pass for the session that is open; true if a permission has ended. */
uint8_t cord_arming_pass(uint16_t session, uint8_t elapsed_ms);
/* `not-armed`, `link-lost` and `stopped`. */
uint32_t cord_arming_inhibits(void);

#endif

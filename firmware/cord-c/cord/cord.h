/* The C cord: the firmware of one robot between its board and the wire.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORD_H
#define CORD_H

#include <stdint.h>

/* Whether power came on, or what is kept was lost. */
extern uint8_t cord_is_first_start;

/* Starts with everything off and nothing armed. `moment` is any value that differs between starts. */
void cord_start(uint16_t moment);
/* One pass of the main loop. */
void cord_pass(void);
/* Flags of a `state`, in the order of SPEC.md, section 8. */
uint16_t cord_flags(void);
/* The firmware has run long enough to be sound (S4). */
void cord_forget_resets(void);
/* What is kept has changed. */
void cord_kept_seal(void);

#endif

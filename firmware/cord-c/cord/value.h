/* Values in the templates of transmit.c.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORD_VALUE_H
#define CORD_VALUE_H

#include <stdint.h>

#define V_SESSION "\201"
#define V_BOOTS "\202"
#define V_RESET "\203"
#define V_BINARY "\204"
#define V_TICK "\205"
#define V_NUMBER "\206"
#define V_REFUSAL "\207"
#define V_FACT_NUMBER "\210"
#define V_FACT_TICK "\211"
#define V_FACT_BITS "\212"
#define V_NAMES "\213"
#define V_ANGLE "\214"
#define V_MOTOR "\215"
#define V_STEPS "\216"
#define V_BYTES_IN "\217"
#define V_BYTES_OUT "\220"
#define V_ARMING "\221"
#define V_LEFT "\222"
#define V_RIGHT "\223"
#define V_WALL "\224"
#define V_FLAGS "\225"
#define V_PHASE "\226"
#define V_INHIBITS "\227"
#define V_TOTAL_0 "\230"
#define V_TOTAL_1 "\231"
#define V_TOTAL_2 "\232"
#define V_TOTAL_3 "\233"
#define V_TOTAL_4 "\234"
#define V_TOTAL_5 "\235"
#define V_TOTAL_6 "\236"
#define V_BIT_0 "\240"
#define V_BIT_1 "\241"
#define V_BIT_2 "\242"
#define V_BIT_3 "\243"
#define V_BIT_4 "\244"
#define V_BIT_5 "\245"

/* Figures of the last second, for `info`. */
extern uint16_t cord_steps_hz;
extern uint16_t cord_bytes_in;
extern uint16_t cord_bytes_out;

/* A packet begins. */
void cord_value_begin(void);
/* The next byte of a packet whose template goes on at `text`; 0 at its end. */
uint8_t cord_value_next(const char **text);

#endif

/* What goes to the host, byte by byte from templates in code memory: no printf, no buffer for a packet, little work in a pass.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORD_TRANSMIT_H
#define CORD_TRANSMIT_H

#include <stdint.h>

void cord_transmit_start(void);
/* Sends some bytes, as far as the line takes them; begins the next packet when one is done. */
void cord_transmit_pass(void);
/* Lets time pass: what is due. */
void cord_transmit_tick(uint8_t elapsed_ms);
/* One report is wanted. */
void cord_transmit_want_state(void);
void cord_transmit_want_info(void);
/* Pauses between reports, 0 = only when asked. */
void cord_transmit_set_state_ms(uint16_t ms);
void cord_transmit_set_info_ms(uint16_t ms);
/* Counted for `info`. */
void cord_transmit_count_byte(void);
void cord_transmit_count_pass(void);

#endif

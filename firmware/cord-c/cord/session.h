/* The robot's end of the link: SPEC.md, sections 4, 5 and 9.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORD_SESSION_H
#define CORD_SESSION_H

#include "port.h"
#include <stdint.h>

/* What a packet means for the firmware. */
enum cord_event {
    CORD_EVENT_NONE,
    CORD_EVENT_COMMAND, /* execute `cord_command` */
    CORD_EVENT_OPENED,  /* a host has opened a session: earlier leases are void */
    CORD_EVENT_CLOSED   /* back to hand mode: so are those of the session */
};

/* What waits to be told to the host. */
enum cord_fact { CORD_FACT_BUMP, CORD_FACT_CLIFF, CORD_FACT_LIFT, CORD_FACT_INHIBITS, CORD_FACT_STALL };

enum cord_reply { CORD_REPLY_NONE, CORD_REPLY_HELLO, CORD_REPLY_ROW, CORD_REPLY_ANSWER, CORD_REPLY_NUMBERED };

/* Events that wait for confirmation; a further one drops the oldest. */
#define CORD_FACTS_MAX 6

struct cord_waiting_fact {
    uint32_t tick;
    uint32_t bits;
    uint8_t kind;
    uint8_t sent; /* when, 0 = never */
};

struct cord_answer {
    uint16_t number;
    uint8_t kind;
    uint8_t refusal; /* or the row */
};

/* Totals since the reset, in the order of `info`. */
enum cord_total { CORD_ACCEPTED, CORD_BAD_SEALS, CORD_OVERRUNS, CORD_FRAMING_ERRORS, CORD_MALFORMED, CORD_REFUSED, CORD_RESYNCS, CORD_TOTALS };
extern uint32_t cord_link_totals[CORD_TOTALS];

/* The present tick in ms, and the session that is open, 0 = none. */
extern CORD_NEAR uint32_t cord_now;
extern CORD_NEAR uint16_t cord_session;
/* Binary kinds that were agreed, and whether they are used no longer. */
extern uint8_t cord_binary;
extern uint8_t cord_has_left_binary;

void cord_session_start(uint32_t seed);
/* Takes a byte of the line. */
uint8_t cord_session_take(uint8_t byte);
void cord_session_framing_error(void);
void cord_session_overrun(void);
/* Lets time pass. */
uint8_t cord_session_pass(void);
/* Answers `cord_command`: 0 = done, else why it is refused. */
void cord_session_answer(uint8_t refusal);
/* The next reply, in `cord_reply`; false if there is none. */
extern struct cord_answer cord_reply;
uint8_t cord_session_next_reply(void);
/* Tells the host of a fact; numbers it. */
void cord_session_tell(uint8_t kind, uint32_t bits);
/* The next event that is due, in `cord_fact` and `cord_fact_number`; false if there is none. */
extern struct cord_waiting_fact cord_fact;
extern uint16_t cord_fact_number;
uint8_t cord_session_next_fact(void);

#endif

/* The robot's end of the link: modes, freshness, answers, sessions.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "session.h"
#include "command.h"
#include "crc.h"
#include "frame.h"
#include "machine.h"
#include "scan.h"
#include "wire.h"
#include "port.h"

/* Numbers that are remembered, and for how long. */
#define REMEMBERED 8
#define MEMORY_MS 10000
/* Answers that wait for the line; the host repeats what is dropped. */
#define REPLIES 8
#define BAD_IN_ROW_MAX 3
#define THROTTLE_HAND 250000L
#define REPEAT_MS 100
/* Of the events that wait for confirmation so many are repeated. */
#define REPEATED 4
#define PENDING 0xFF

struct remembered {
    uint16_t number;
    uint16_t age_ms; /* 0 = nothing remembered */
    uint8_t answer;  /* PENDING, 0 or why it was refused */
};

uint32_t cord_link_totals[CORD_TOTALS];
CORD_NEAR uint32_t cord_now;
CORD_NEAR uint16_t cord_session;
uint8_t cord_binary;
uint8_t cord_has_left_binary;
struct cord_answer cord_reply;
struct cord_waiting_fact cord_fact;
uint16_t cord_fact_number;

static struct remembered remembered[REMEMBERED];
static struct cord_answer replies[REPLIES];
static uint8_t reply_first, reply_count;
static struct cord_waiting_fact facts[CORD_FACTS_MAX];
static uint8_t fact_first, fact_count;
/* Number of the oldest event that waits. */
static uint16_t fact_base;
static uint32_t session_seed;
/* When the last valid packet with a CRC came. */
static uint32_t heard;
/* Milliseconds since the last accepted motion, at most MEMORY_MS; and its number. */
static uint16_t motion_age_ms;
static uint16_t motion_number;
static uint32_t aged;
static uint8_t bad_in_row;
/* The `hello` that opened the session, until another packet with a CRC comes. */
static uint8_t is_opened_by;
static uint8_t opened_least, opened_most, opened_binary;

static void count(uint8_t total) {
    cord_link_totals[total]++;
}

static void forget_numbers(void) {
    uint8_t index;
    for (index = 0; index < REMEMBERED; index++) {
        remembered[index].age_ms = 0;
    }
    motion_age_ms = MEMORY_MS;
}

static void reply(uint8_t kind, uint8_t refusal, uint8_t has_number, uint16_t number) {
    struct cord_answer *slot;
    if (reply_count == REPLIES) {
        return;
    }
    slot = &replies[(uint8_t)(reply_first + reply_count) & (REPLIES - 1)];
    reply_count++;
    slot->kind = has_number ? CORD_REPLY_NUMBERED : kind;
    slot->refusal = refusal;
    slot->number = number;
}

void cord_session_start(uint32_t seed) {
    uint8_t index;
    for (index = 0; index < CORD_TOTALS; index++) {
        cord_link_totals[index] = 0;
    }
    cord_session = 0;
    cord_binary = 0;
    cord_has_left_binary = 0;
    reply_first = reply_count = 0;
    fact_first = fact_count = 0;
    fact_base = 0;
    session_seed = seed;
    heard = cord_now;
    aged = cord_now;
    bad_in_row = 0;
    is_opened_by = 0;
    forget_numbers();
    cord_frame_start();
    reply(CORD_REPLY_HELLO, 0, 0, 0);
}

uint8_t cord_session_next_reply(void) {
    if (reply_count == 0) {
        return 0;
    }
    cord_reply = replies[reply_first];
    reply_first = (uint8_t)(reply_first + 1) & (REPLIES - 1);
    reply_count--;
    return 1;
}

/* A place in the ring of events. */
static uint8_t wrapped(uint8_t place) {
    return (uint8_t)(place >= CORD_FACTS_MAX ? place - CORD_FACTS_MAX : place);
}

void cord_session_tell(uint8_t kind, uint32_t bits) {
    struct cord_waiting_fact *slot;
    if (fact_count == CORD_FACTS_MAX) {
        fact_first = wrapped((uint8_t)(fact_first + 1));
        fact_count--;
        fact_base++;
    }
    slot = &facts[wrapped((uint8_t)(fact_first + fact_count))];
    fact_count++;
    slot->kind = kind;
    slot->bits = bits;
    slot->tick = cord_now;
    slot->sent = 0;
}

static void drop_fact(void) {
    fact_first = wrapped((uint8_t)(fact_first + 1));
    fact_count--;
    fact_base++;
}

uint8_t cord_session_next_fact(void) {
    uint8_t index;
    /* In units of 4 ms; 0 is for those that were never sent. */
    uint8_t now = (uint8_t)((uint16_t)cord_now >> 2) | 1;
    for (index = 0; index < fact_count; index++) {
        struct cord_waiting_fact *slot = &facts[wrapped((uint8_t)(fact_first + index))];
        if (slot->sent != 0 && (index >= REPEATED || (uint8_t)(now - slot->sent) < REPEAT_MS / 4)) {
            continue;
        }
        slot->sent = now;
        cord_fact = *slot;
        cord_fact_number = fact_base + index;
        if (cord_session == 0) {
            drop_fact();
        }
        return 1;
    }
    return 0;
}

static uint8_t is_newer(uint16_t number, uint16_t other) {
    uint16_t ahead = (uint16_t)(number - other);
    return ahead != 0 && ahead < 0x8000;
}

/* Drops the events up to this number. */
static void confirm(uint16_t number) {
    while (fact_count != 0 && !is_newer(fact_base, number)) {
        drop_fact();
    }
}

static uint8_t refuse(uint8_t why, uint8_t has_number, uint16_t number) {
    count(CORD_REFUSED);
    reply(CORD_REPLY_ANSWER, why, has_number, number);
    return CORD_EVENT_NONE;
}

static uint8_t refuse_packet(uint8_t why) {
    uint8_t has_number = cord_command_number();
    return refuse(why, has_number, has_number ? (uint16_t)cord_number : 0);
}

/* Keeps the answer to a number for its repeats. */
static void give(uint16_t number, uint8_t refusal) {
    uint8_t index;
    for (index = 0; index < REMEMBERED; index++) {
        if (remembered[index].age_ms != 0 && remembered[index].number == number) {
            remembered[index].answer = refusal;
        }
    }
}

void cord_session_answer(uint8_t refusal) {
    give(cord_command.number, refusal);
    if (refusal != 0) {
        count(CORD_REFUSED);
    }
    reply(CORD_REPLY_ANSWER, refusal, 1, cord_command.number);
}

/* A valid packet with a CRC. */
static void good(void) {
    heard = cord_now;
    bad_in_row = 0;
    is_opened_by = 0;
}

static uint8_t bad(void) {
    if (bad_in_row < BAD_IN_ROW_MAX) {
        bad_in_row++;
    }
    if (bad_in_row == BAD_IN_ROW_MAX) {
        cord_has_left_binary = 1;
    }
    return CORD_EVENT_NONE;
}

static uint8_t close(void) {
    cord_session = 0;
    cord_binary = 0;
    is_opened_by = 0;
    forget_numbers();
    reply(CORD_REPLY_HELLO, 0, 0, 0);
    return CORD_EVENT_CLOSED;
}

/* A number that differs from the last one and, very likely, from those before the reset. */
static uint16_t new_session(void) {
    uint32_t parts[2];
    uint8_t index;
    uint16_t number;
    cord_crc_start('<', cord_session);
    parts[0] = session_seed;
    parts[1] = cord_now;
    for (index = 0; index < 8; index++) {
        cord_crc_take((uint8_t)parts[index >> 2]);
        parts[index >> 2] >>= 8;
    }
    cord_crc_finish(8);
    number = (uint16_t)((uint16_t)(cord_crc.b0 ^ cord_crc.b2) | (uint16_t)((uint16_t)(cord_crc.b1 ^ cord_crc.b3) << 8));
    if (number == 0 || number == cord_session) {
        number = (uint16_t)(cord_session + 1);
        if (number == 0) {
            number = 1;
        }
    }
    return number;
}

static uint8_t greet(uint8_t is_checked) {
    uint8_t is_repeat = is_opened_by && opened_least == cord_command.what && opened_most == cord_command.detail &&
                        opened_binary == cord_command.flag;
    count(CORD_ACCEPTED);
    reply(CORD_REPLY_HELLO, 0, 0, 0);
    if (!is_checked || is_repeat || cord_command.what > CORD_VERSION_MOST || cord_command.detail < CORD_VERSION_LEAST) {
        return CORD_EVENT_NONE;
    }
    cord_session = new_session();
    cord_binary = cord_command.flag;
    cord_has_left_binary = 0;
    forget_numbers();
    fact_first = fact_count = 0;
    fact_base = 0;
    good();
    is_opened_by = 1;
    opened_least = cord_command.what;
    opened_most = cord_command.detail;
    opened_binary = cord_command.flag;
    return CORD_EVENT_OPENED;
}

/* Whether motion is fresh: 0, or why not. */
static uint8_t judge_freshness(void) {
    if (cord_now - cord_command.tick > CORD_FRESHNESS_MS) {
        return CORD_REFUSAL_STALE;
    }
    if (cord_session == 0) {
        return 0;
    }
    if (motion_age_ms < MEMORY_MS && !is_newer(cord_command.number, motion_number)) {
        return CORD_REFUSAL_OLD;
    }
    motion_number = cord_command.number;
    motion_age_ms = 0;
    return 0;
}

static int32_t within(int32_t value, int32_t most) {
    if (value > most) {
        return most;
    }
    return value < -most ? -most : value;
}

/* Limits of hand mode. */
static void clamp(void) {
    if (cord_command.name == CORD_COMMAND_DRIVE) {
        cord_command.value = within(cord_command.value, CORD_HAND_SPEED_MAX);
        cord_command.second = within(cord_command.second, CORD_HAND_TURN_MAX);
    } else if (cord_command.name != CORD_COMMAND_MOTOR) {
        return;
    } else if (cord_command.what <= CORD_MOTOR_WHEEL_RIGHT) {
        cord_command.value = within(cord_command.value, THROTTLE_HAND);
    }
    if (cord_command.lease_ms > CORD_HAND_LEASE_MS_MAX) {
        cord_command.lease_ms = CORD_HAND_LEASE_MS_MAX;
    }
}

static uint8_t act(uint8_t refusal, uint8_t has_number) {
    if (refusal != 0) {
        return refuse(refusal, has_number, cord_command.number);
    }
    count(CORD_ACCEPTED);
    if (cord_session == 0) {
        clamp();
    }
    return CORD_EVENT_COMMAND;
}

/* The place for a new number: a free one, or that of the lowest below it; REMEMBERED if there is none. */
static uint8_t place_for(uint16_t number) {
    uint16_t bound = number;
    uint8_t lowest = REMEMBERED;
    uint8_t index;
    for (index = 0; index < REMEMBERED; index++) {
        if (remembered[index].age_ms == 0) {
            return index;
        }
        if (is_newer(bound, remembered[index].number)) {
            bound = remembered[index].number;
            lowest = index;
        }
    }
    return lowest;
}

/* A command that must arrive: executed once, answered for each repeat. */
static uint8_t accept_once(void) {
    uint16_t number = cord_command.number;
    uint8_t index;
    uint8_t refusal = 0;
    if (cord_session != 0) {
        for (index = 0; index < REMEMBERED; index++) {
            if (remembered[index].age_ms != 0 && remembered[index].number == number) {
                count(CORD_ACCEPTED);
                if (remembered[index].answer != PENDING) {
                    reply(CORD_REPLY_ANSWER, remembered[index].answer, 1, number);
                }
                return CORD_EVENT_NONE;
            }
        }
        index = place_for(number);
        if (index == REMEMBERED) {
            return refuse(CORD_REFUSAL_OLD, 1, number);
        }
        remembered[index].number = number;
        remembered[index].age_ms = 1;
        remembered[index].answer = PENDING;
    }
    if (cord_command.name == CORD_COMMAND_MOVE) {
        refusal = judge_freshness();
        if (refusal != 0) {
            give(number, refusal);
        }
    }
    return act(refusal, 1);
}

static uint8_t accept(uint8_t is_checked) {
    switch (cord_command.name) {
    case CORD_COMMAND_HELLO:
        return greet(is_checked);
    case CORD_COMMAND_HAND:
        count(CORD_ACCEPTED);
        return cord_session != 0 ? close() : CORD_EVENT_NONE;
    case CORD_COMMAND_DESCRIBE:
        if (cord_command.what >= CORD_ROWS) {
            return refuse(CORD_REFUSAL_RANGE, 0, 0);
        }
        count(CORD_ACCEPTED);
        reply(CORD_REPLY_ROW, cord_command.what, 0, 0);
        return CORD_EVENT_NONE;
    case CORD_COMMAND_PING:
        count(CORD_ACCEPTED);
        reply(CORD_REPLY_ANSWER, 0, 1, cord_command.number);
        return CORD_EVENT_NONE;
    case CORD_COMMAND_SEEN:
        count(CORD_ACCEPTED);
        confirm(cord_command.number);
        return CORD_EVENT_NONE;
    case CORD_COMMAND_DRIVE:
    case CORD_COMMAND_MOTOR:
        return act(judge_freshness(), 1);
    case CORD_COMMAND_INFO:
    case CORD_COMMAND_STATE:
    case CORD_COMMAND_STOP:
        return act(0, 0);
    case CORD_COMMAND_BEEP:
    case CORD_COMMAND_LED:
        return refuse(CORD_REFUSAL_ABSENT, 0, 0);
    default:
        return accept_once();
    }
}

/* Reads the text that was framed, and accepts or refuses it. */
static uint8_t take_text(uint8_t is_checked) {
    uint8_t form = cord_session != 0 ? CORD_FORM_CHECKED : is_checked ? CORD_FORM_SEALED_HAND : CORD_FORM_HAND;
    uint8_t refusal = cord_command_read(form, cord_now);
    if (refusal != 0) {
        return refuse_packet(refusal);
    }
    if (is_checked && (cord_binary & CORD_BINARY_DRIVE) && cord_command.name == CORD_COMMAND_DRIVE) {
        cord_has_left_binary = 1;
    }
    return accept(is_checked);
}

static uint8_t take_stop(void) {
    cord_command.name = CORD_COMMAND_STOP;
    return act(0, 0);
}

static uint8_t take_unchecked(void) {
    if (cord_command_is_pattern()) {
        return CORD_EVENT_NONE;
    }
    if (cord_command_is_stop()) {
        return take_stop();
    }
    if (cord_session != 0) {
        bad();
        return refuse(CORD_REFUSAL_UNSEALED, 0, 0);
    }
    return take_text(0);
}

static uint8_t take_bad_crc(void) {
    if (cord_command_is_stop()) {
        return take_stop();
    }
    if (cord_session != 0 && cord_command_read(CORD_FORM_CHECKED, cord_now) == 0 &&
        cord_command.name == CORD_COMMAND_HELLO && cord_frame_has_crc_of_no_session()) {
        return accept(1);
    }
    count(CORD_BAD_SEALS);
    return bad();
}

static uint8_t take_binary(void) {
    uint8_t refusal = CORD_REFUSAL_UNKNOWN;
    good();
    if (cord_packet[0] == CORD_KIND_DRIVE && (cord_binary & CORD_BINARY_DRIVE)) {
        refusal = cord_command_read_drive();
        if (refusal == 0) {
            return accept(1);
        }
    }
    return refuse(refusal, 0, 0);
}

static uint8_t take_framed(uint8_t framed) {
    switch (framed) {
    case CORD_FRAMED_CHECKED:
        good();
        return take_text(1);
    case CORD_FRAMED_BINARY:
        return take_binary();
    case CORD_FRAMED_UNCHECKED:
        return take_unchecked();
    case CORD_FRAMED_BAD_CRC:
        return take_bad_crc();
    case CORD_FRAMED_BINARY_BAD_CRC:
        count(CORD_BAD_SEALS);
        return bad();
    case CORD_FRAMED_TOO_LONG:
    case CORD_FRAMED_CONTROL_BYTE:
        count(CORD_MALFORMED);
        break;
    default:
        break;
    }
    count(CORD_RESYNCS);
    return bad();
}

uint8_t cord_session_take(uint8_t byte) {
    uint8_t event;
    uint8_t framed = cord_frame_take(byte);
    if (framed == CORD_FRAMED_NOTHING) {
        return CORD_EVENT_NONE;
    }
    event = take_framed(framed);
    if (event == CORD_EVENT_OPENED || event == CORD_EVENT_CLOSED) {
        cord_frame_set_session(cord_session);
    }
    return event;
}

void cord_session_framing_error(void) {
    count(CORD_FRAMING_ERRORS);
    cord_frame_poison(CORD_FRAMED_FRAMING_ERROR);
}

void cord_session_overrun(void) {
    count(CORD_OVERRUNS);
    cord_frame_poison(CORD_FRAMED_OVERRUN);
}

/* Lets remembered numbers age; a number is forgotten at MEMORY_MS. */
static void age(uint16_t passed_ms) {
    uint8_t index;
    if (motion_age_ms < MEMORY_MS) {
        motion_age_ms += passed_ms;
    }
    for (index = 0; index < REMEMBERED; index++) {
        if (remembered[index].age_ms != 0) {
            remembered[index].age_ms += passed_ms;
            if (remembered[index].age_ms > MEMORY_MS) {
                remembered[index].age_ms = 0;
            }
        }
    }
}

uint8_t cord_session_pass(void) {
    uint16_t passed_ms = (uint16_t)(cord_now - aged);
    if (passed_ms >= REPEAT_MS) {
        age(passed_ms);
        aged = cord_now;
    }
    if (cord_session == 0 || cord_now - heard <= CORD_SESSION_SILENCE_MS) {
        return CORD_EVENT_NONE;
    }
    close();
    cord_frame_set_session(0);
    return CORD_EVENT_CLOSED;
}

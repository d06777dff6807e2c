/* What goes to the host. A template is text in which bytes from 0x80 on stand for a value; it is written while it is sent, so that
 * no pass of the main loop has to make a whole packet.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "transmit.h"
#include "arming.h"
#include "board.h"
#include "cord.h"
#include "crc.h"
#include "frame.h"
#include "inhibit.h"
#include "machine.h"
#include "motion.h"
#include "session.h"
#include "value.h"
#include "wire.h"
#include "port.h"

#define FLUSH_AFTER_MS 100
#define STATE_MS 20
#define INFO_MS 1000
#define RATE_MS 1000
/* Bytes that are made in one pass. */
#define BYTES_IN_PASS 4
/* Packets of an `info`. */
#define INFO_PARTS 2
#define CHARGE_AND_PHASE_SHIFT 4
#define TEXT_OF(macro) #macro
#define TEXT(macro) TEXT_OF(macro)

static const char hello_text[] =
    "{\"c\":\"hello\",\"min\":1,\"max\":1,\"device\":\"" CORD_DEVICE "\",\"firmware\":\"" CORD_FIRMWARE
    "\",\"session\":" V_SESSION ",\"packet\":" TEXT(CORD_PACKET_MOST) ",\"boots\":" V_BOOTS ",\"reset\":\"" V_RESET "\",\"bin\":\"" V_BINARY
    "\",\"t\":" V_TICK "}";
static const char answer_text[] = "{\"a\":" V_NUMBER "}";
static const char refusal_text[] = "{\"a\":" V_NUMBER ",\"err\":\"" V_REFUSAL "\"}";
static const char link_text[] =
    "{\"c\":\"info\",\"accepted\":" V_TOTAL_0 ",\"bad-seals\":" V_TOTAL_1 ",\"overruns\":" V_TOTAL_2
    ",\"framing-errors\":" V_TOTAL_3 ",\"malformed\":" V_TOTAL_4 ",\"refused\":" V_TOTAL_5 ",\"resyncs\":" V_TOTAL_6 "}";
static const char firmware_text[] =
    "{\"c\":\"info\",\"firmware-version\":\"" CORD_FIRMWARE "\",\"cordlib-version\":\"" CORD_FIRMWARE
    "\",\"main-steps\":" V_STEPS ",\"bandwidth-in\":" V_BYTES_IN ",\"bandwidth-out\":" V_BYTES_OUT
    ",\"arming\":\"" V_ARMING "\"}";
static const char state_text[] =
    "{\"c\":\"state\",\"t\":" V_TICK ",\"l\":" V_LEFT ",\"r\":" V_RIGHT ",\"p\":\"" V_WALL
    "00000000000000\",\"d\":\"00000000\",\"f\":\"" V_FLAGS
    "\",\"k\":0,\"x\":0,\"y\":0,\"z\":0,\"v\":0,\"a\":0,\"s\":\"d" V_PHASE "\",\"i\":" V_INHIBITS "}";
#define FACT_END ",\"n\":" V_FACT_NUMBER ",\"t\":" V_FACT_TICK "}"
static const char bump_text[] = "{\"e\":\"bump\",\"angle\":" V_ANGLE ",\"left\":" V_BIT_0 ",\"right\":" V_BIT_1 FACT_END;
static const char cliff_text[] =
    "{\"e\":\"cliff\",\"left\":" V_BIT_2 ",\"middle\":" V_BIT_3 ",\"right\":" V_BIT_4 FACT_END;
static const char lift_text[] = "{\"e\":\"lift\",\"left\":" V_BIT_5 ",\"right\":" V_BIT_5 FACT_END;
static const char inhibits_text[] = "{\"e\":\"inhibits\",\"bits\":" V_FACT_BITS ",\"names\":\"" V_NAMES "\"" FACT_END;
static const char stall_text[] = "{\"e\":\"stall\",\"motor\":\"" V_MOTOR "\"" FACT_END;
static const char row_0[] = CORD_ROW_0;
static const char row_1[] = CORD_ROW_1;
static const char row_2[] = CORD_ROW_2;
static const char row_3[] = CORD_ROW_3;
static const char row_4[] = CORD_ROW_4;
static const char row_5[] = CORD_ROW_5;
static const char *const rows[CORD_ROWS] = {row_0, row_1, row_2, row_3, row_4, row_5};
static const char *const facts[] = {bump_text, cliff_text, lift_text, inhibits_text, stall_text};

enum stage { STAGE_IDLE, STAGE_TEXT, STAGE_DIGITS, STAGE_BINARY, STAGE_STUFFED, STAGE_SEAL, STAGE_END };

static CORD_NEAR uint8_t stage;
static uint8_t is_binary;
static const char *CORD_NEAR text;
static CORD_NEAR uint16_t length;
static CORD_NEAR struct cord_crc crc;
/* Bytes of the CRC, or of the binary body, that are sent. */
static CORD_NEAR uint8_t at;
/* The second byte of a stuffed one. */
static uint8_t stuffed;
static uint8_t body[CORD_STATE_BYTES + 1];
static uint16_t quiet_ms;
static uint16_t state_ms, info_ms;
static uint16_t state_age_ms, info_age_ms, rate_age_ms;
static uint8_t wants_state, was_state, info_parts;
static uint16_t steps, bytes_in, bytes_out;

void cord_transmit_start(void) {
    stage = STAGE_IDLE;
    quiet_ms = FLUSH_AFTER_MS;
    state_ms = STATE_MS;
    info_ms = INFO_MS;
    state_age_ms = info_age_ms = rate_age_ms = 0;
    wants_state = was_state = info_parts = 0;
    steps = bytes_in = bytes_out = 0;
    cord_steps_hz = cord_bytes_in = cord_bytes_out = 0;
}

void cord_transmit_want_state(void) {
    wants_state = 1;
}

void cord_transmit_want_info(void) {
    info_parts = INFO_PARTS;
}

void cord_transmit_set_state_ms(uint16_t ms) {
    state_ms = ms;
    state_age_ms = 0;
}

void cord_transmit_set_info_ms(uint16_t ms) {
    info_ms = ms;
    info_age_ms = 0;
}

void cord_transmit_count_byte(void) {
    bytes_in++;
}

void cord_transmit_count_pass(void) {
    steps++;
}

/* Lets a period run; true when it is over. Missed periods are dropped. */
static uint8_t is_due(uint16_t *age_ms, uint16_t period_ms, uint8_t elapsed_ms) {
    *age_ms += elapsed_ms;
    if (period_ms == 0 || *age_ms < period_ms) {
        return 0;
    }
    *age_ms -= period_ms;
    if (*age_ms >= period_ms) {
        *age_ms = 0;
    }
    return 1;
}

void cord_transmit_tick(uint8_t elapsed_ms) {
    if (quiet_ms < FLUSH_AFTER_MS) {
        quiet_ms += elapsed_ms;
    }
    if (is_due(&rate_age_ms, RATE_MS, elapsed_ms)) {
        cord_steps_hz = steps;
        cord_bytes_in = bytes_in;
        cord_bytes_out = bytes_out;
        steps = bytes_in = bytes_out = 0;
    }
    if (is_due(&info_age_ms, info_ms, elapsed_ms)) {
        info_parts = INFO_PARTS;
    }
    if (is_due(&state_age_ms, state_ms, elapsed_ms) && cord_session != 0) {
        wants_state = 1;
    }
}

static uint8_t put_long(uint8_t place, uint32_t value) {
    body[place] = (uint8_t)value;
    body[place + 1] = (uint8_t)(value >> 8);
    body[place + 2] = (uint8_t)(value >> 16);
    body[place + 3] = (uint8_t)(value >> 24);
    return (uint8_t)(place + 4);
}

/* Takes a snapshot of everything, in the layout of SPEC.md, section 8. */
static void fill_state(void) {
    uint16_t flags = cord_flags();
    uint8_t place;
    for (place = 0; place <= CORD_STATE_BYTES; place++) {
        body[place] = 0;
    }
    body[0] = CORD_KIND_STATE;
    put_long(1, cord_now);
    put_long(5, (uint32_t)cord_total[0]);
    put_long(9, (uint32_t)cord_total[1]);
    body[21] = cord_board_wall();
    body[33] = (uint8_t)flags;
    body[34] = (uint8_t)(flags >> 8);
    body[36] = (uint8_t)(cord_phase() << CHARGE_AND_PHASE_SHIFT);
    put_long(47, cord_inhibits);
}

static void begin_text(const char *template, uint16_t session) {
    text = template;
    is_binary = 0;
    cord_value_begin();
    cord_crc_start('<', session);
    crc = cord_crc;
}

static uint8_t begin_reply(void) {
    switch (cord_reply.kind) {
    case CORD_REPLY_HELLO:
        begin_text(hello_text, 0);
        break;
    case CORD_REPLY_ROW:
        begin_text(rows[cord_reply.refusal], cord_session);
        break;
    default:
        begin_text(cord_reply.refusal == 0 ? answer_text : refusal_text, cord_session);
        break;
    }
    return 1;
}

static uint8_t begin_state(void) {
    wants_state = 0;
    was_state = 1;
    if ((cord_binary & 1) == 0 || cord_has_left_binary) {
        begin_text(state_text, cord_session);
        return 1;
    }
    fill_state();
    is_binary = 1;
    at = 0;
    cord_crc_start('<', cord_session);
    crc = cord_crc;
    return 1;
}

/* Chooses the next packet: what the session wants, then `info`, then `state`; but on a slow line no two others come between two
 * states that are due, because the host drives slowly when it waits for one. */
static uint8_t begin(void) {
    if (wants_state && !was_state) {
        return begin_state();
    }
    was_state = 0;
    if (cord_session_next_reply()) {
        return begin_reply();
    }
    if (cord_session_next_fact()) {
        begin_text(facts[cord_fact.kind], cord_session);
        return 1;
    }
    if (info_parts != 0) {
        begin_text(info_parts == INFO_PARTS ? link_text : firmware_text, cord_session);
        info_parts--;
        return 1;
    }
    return wants_state ? begin_state() : 0;
}

static void send(uint8_t byte) {
    cord_board_send(byte);
    bytes_out++;
}

/* Sends a byte after the kind, stuffed if it must be. */
static void send_binary(uint8_t byte, uint8_t next) {
    stage = next;
    if (byte >= CORD_STUFFING && byte <= CORD_SEPARATOR) {
        stuffed = byte ^ CORD_STUFFED_BIT;
        send(CORD_STUFFING);
        stage = STAGE_STUFFED;
        return;
    }
    send(byte);
}

static uint8_t crc_byte(uint8_t index) {
    switch (index) {
    case 0:
        return crc.b0;
    case 1:
        return crc.b1;
    case 2:
        return crc.b2;
    default:
        return crc.b3;
    }
}

static void finish_crc(uint16_t bytes) {
    cord_crc = crc;
    cord_crc_finish(bytes);
    crc = cord_crc;
}

static void step_text(void) {
    uint8_t byte = cord_value_next(&text);
    if (byte == 0) {
        finish_crc(length);
        send('*');
        at = 0;
        stage = STAGE_DIGITS;
        return;
    }
    CORD_CRC_TAKE(crc, byte);
    length++;
    send(byte);
}

static void step_digits(void) {
    uint8_t byte = crc_byte((uint8_t)(3 - (at >> 1)));
    uint8_t digit = (at & 1) ? (byte & 15) : (uint8_t)(byte >> 4);
    send((uint8_t)(digit < 10 ? '0' + digit : 'A' - 10 + digit));
    at++;
    if (at == 8) {
        stage = STAGE_END;
    }
}

static void step_binary(void) {
    uint8_t byte = body[at];
    CORD_CRC_TAKE(crc, byte);
    at++;
    if (at == 1) {
        send(byte);
    } else {
        send_binary(byte, STAGE_BINARY);
    }
    if (at == CORD_STATE_BYTES + 1 && stage == STAGE_BINARY) {
        stage = STAGE_SEAL;
    }
    if (at == CORD_STATE_BYTES + 1) {
        finish_crc(CORD_STATE_BYTES + 1);
    }
}

/* After a stuffed byte: back to the body or to the CRC behind it. */
static void step_stuffed(void) {
    send(stuffed);
    if (at <= CORD_STATE_BYTES) {
        stage = STAGE_BINARY;
    } else {
        stage = at == CORD_STATE_BYTES + 5 ? STAGE_END : STAGE_SEAL;
    }
}

static void step_seal(void) {
    uint8_t byte = crc_byte((uint8_t)(at - CORD_STATE_BYTES - 1));
    at++;
    send_binary(byte, at == CORD_STATE_BYTES + 5 ? STAGE_END : STAGE_SEAL);
}

/* Makes one byte; false if there is nothing to send. */
static uint8_t step(void) {
    switch (stage) {
    case STAGE_IDLE:
        if (!begin()) {
            return 0;
        }
        length = 0;
        stage = is_binary ? STAGE_BINARY : STAGE_TEXT;
        if (quiet_ms >= FLUSH_AFTER_MS) {
            send(CORD_SEPARATOR);
        }
        break;
    case STAGE_TEXT:
        step_text();
        break;
    case STAGE_DIGITS:
        step_digits();
        break;
    case STAGE_BINARY:
        step_binary();
        break;
    case STAGE_STUFFED:
        step_stuffed();
        break;
    case STAGE_SEAL:
        step_seal();
        break;
    default:
        send(CORD_SEPARATOR);
        stage = STAGE_IDLE;
        break;
    }
    quiet_ms = 0;
    return 1;
}

void cord_transmit_pass(void) {
    uint8_t count;
    for (count = 0; count < BYTES_IN_PASS; count++) {
        if (cord_board_room() == 0 || !step()) {
            return;
        }
    }
}

/* The whole cord on a board of plain memory, a millisecond or a packet at a time, as lines of text say:
 *
 *   S CONTACTS OVERLOADS LOW LEFT RIGHT BYTES   a millisecond with these senses and edges; bytes in hexadecimal, or -
 *   D BYTES                                     so many milliseconds as the bytes take at eight in each
 *   !                                           what was answered goes out
 *
 * Answers: S: duty left, duty right, cleaners, bytes that were sent or -. D: milliseconds with a motor on, the tick.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "arming.h"
#include "board.h"
#include "cord.h"
#include "motion.h"
#include "session.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE_BYTES 65536
/* Passes of a millisecond: fewer than the chip's, and enough for the bytes that come in it. */
#define PASSES 4

static char line[LINE_BYTES];
static uint8_t arrived[LINE_BYTES];
static size_t arrived_from, arrived_to;
static uint8_t sent[LINE_BYTES];
static size_t sent_count;
static uint8_t elapsed_ms;
static uint8_t contacts, overloads, is_battery_low;
static uint8_t edges[2];
static int16_t duty[2];
static uint8_t cleaners;

uint8_t cord_byte;
struct cord_kept cord_kept;

uint8_t cord_board_is_program_sound(void) {
    return 1;
}

uint8_t cord_board_elapsed_ms(void) {
    uint8_t elapsed = elapsed_ms;
    elapsed_ms = 0;
    return elapsed;
}

uint8_t cord_board_contacts(void) {
    return contacts;
}

uint8_t cord_board_overloads(void) {
    return overloads;
}

uint8_t cord_board_is_battery_low(void) {
    return is_battery_low;
}

uint8_t cord_board_wall(void) {
    return 0;
}

uint8_t cord_board_edges(uint8_t side) {
    uint8_t count = edges[side];
    edges[side] = 0;
    return count;
}

void cord_board_drive(void) {
    duty[0] = cord_duty[0];
    duty[1] = cord_duty[1];
}

void cord_board_clean(uint8_t motors) {
    cleaners = motors;
}

void cord_board_off(void) {
    duty[0] = duty[1] = 0;
    cleaners = 0;
}

uint8_t cord_board_receive(void) {
    if (arrived_from == arrived_to) {
        return CORD_RECEIVED_NOTHING;
    }
    cord_byte = arrived[arrived_from++];
    return CORD_RECEIVED_BYTE;
}

uint8_t cord_board_room(void) {
    return sent_count < LINE_BYTES ? 255 : 0;
}

void cord_board_send(uint8_t byte) {
    sent[sent_count++] = byte;
}

void cord_board_feed(void) {
}

static int digit(char letter) {
    return letter <= '9' ? letter - '0' : letter - 'a' + 10;
}

static void arrive(const char *from) {
    /* What waits goes on waiting. */
    memmove(arrived, arrived + arrived_from, arrived_to - arrived_from);
    arrived_to -= arrived_from;
    arrived_from = 0;
    while (arrived_to < sizeof arrived && from[0] >= '0' && from[1] >= '0') {
        arrived[arrived_to++] = (uint8_t)(digit(from[0]) << 4 | digit(from[1]));
        from += 2;
    }
}

static void take_senses(char *from) {
    contacts = (uint8_t)strtoul(from, &from, 10);
    overloads = (uint8_t)strtoul(from, &from, 10);
    is_battery_low = (uint8_t)strtoul(from, &from, 10);
    edges[0] = (uint8_t)strtoul(from, &from, 10);
    edges[1] = (uint8_t)strtoul(from, &from, 10);
    arrive(from + 1);
}

static void answer_millisecond(void) {
    size_t index;
    uint8_t pass;
    elapsed_ms = 1;
    sent_count = 0;
    for (pass = 0; pass < PASSES; pass++) {
        cord_pass();
    }
    printf("%d %d %u ", duty[0], duty[1], cleaners);
    for (index = 0; index < sent_count; index++) {
        printf("%02x", sent[index]);
    }
    printf(sent_count == 0 ? "-\n" : "\n");
}

static void answer_packet(void) {
    unsigned on_ms = 0;
    do {
        elapsed_ms = 1;
        sent_count = 0;
        cord_pass();
        on_ms += duty[0] != 0 || duty[1] != 0 || cleaners != 0;
    } while (arrived_from != arrived_to);
    printf("%u %" PRIu32 " %u\n", on_ms, cord_now, cord_arming_state());
}

int main(void) {
    cord_start(1);
    while (fgets(line, sizeof line, stdin) != NULL) {
        switch (line[0]) {
        case 'S':
            take_senses(line + 1);
            answer_millisecond();
            break;
        case 'D':
            arrive(line + 2);
            answer_packet();
            break;
        case '!':
            fflush(stdout);
            break;
        default:
            printf("?\n");
            return 1;
        }
    }
    return 0;
}

/* The C parser as a program: verdicts on packets that come line by line, for the tests that compare it with Rust.
 *
 *   F SESSION HEX     packets in a stream
 *   R FORM TICK HEX   a command in a text; FORM is 0 checked, 1 hand, 2 sealed hand
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "../cord/command.h"
#include "../cord/frame.h"
#include "../cord/scan.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char line[1 << 16];
static uint8_t bytes[1 << 15];

static int digit(char letter) {
    return letter <= '9' ? letter - '0' : letter - 'a' + 10;
}

static size_t from_hex(const char *digits) {
    size_t count = 0;
    while (digits[0] > ' ' && digits[1] > ' ') {
        bytes[count++] = (uint8_t)(digit(digits[0]) * 16 + digit(digits[1]));
        digits += 2;
    }
    return count;
}

static void frames(char *rest) {
    static const char *const names[] = {"",           "open",     "sealed",       "missealed",     "binary",
                                        "binary-missealed", "too-long", "control-byte", "framing-error", "overrun"};
    uint16_t session = (uint16_t)strtoul(rest, &rest, 10);
    size_t count = from_hex(rest + 1);
    size_t index;
    cord_frame_start();
    cord_frame_set_session(session);
    for (index = 0; index < count; index++) {
        uint8_t framed = cord_frame_take(bytes[index]);
        uint16_t at;
        if (framed == CORD_FRAMED_NOTHING) {
            continue;
        }
        printf(" %s:", names[framed]);
        if (framed <= CORD_FRAMED_BINARY) {
            for (at = 0; at < cord_packet_length; at++) {
                printf("%02x", cord_packet[at]);
            }
        }
    }
    printf("\n");
}

static void reads(char *rest) {
    uint8_t form = (uint8_t)strtoul(rest, &rest, 10);
    uint32_t tick = (uint32_t)strtoul(rest, &rest, 10);
    size_t count = from_hex(rest + 1);
    uint8_t refusal;
    memcpy(cord_packet, bytes, count);
    cord_packet_length = (uint16_t)count;
    cord_packet[count] = 0;
    cord_packet_bits = 0x80;
    memset(&cord_command, 0, sizeof cord_command);
    refusal = cord_command_read(form, tick);
    printf("%u ", cord_command_is_stop());
    if (refusal != 0) {
        printf("refused %u ", refusal);
        if (cord_command_number()) {
            printf("%" PRIu32 "\n", cord_number);
        } else {
            printf("-\n");
        }
        return;
    }
    printf("command %u %u %u %u %" PRId32 " %" PRId32 " %u %u %" PRIu32 "\n", cord_command.name,
           cord_command.what, cord_command.detail, cord_command.flag, cord_command.value, cord_command.second,
           cord_command.lease_ms, cord_command.number, cord_command.tick);
}

int main(void) {
    while (fgets(line, sizeof line, stdin) != NULL) {
        switch (line[0]) {
        case 'F':
            frames(line + 1);
            break;
        case 'R':
            reads(line + 1);
            break;
        default:
            printf("?\n");
            return 1;
        }
    }
    return 0;
}

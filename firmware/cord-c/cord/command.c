/* Commands, each key compared byte for byte, straight from the packet.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "command.h"
#include "frame.h"
#include "scan.h"
#include "wire.h"
#include "port.h"

#define LEASE_DEFAULT_MS 250
#define KEYS_MAX 6
#define MILLION 1000000L

struct cord_command cord_command;

/* Keys of the commands: the length of each before it. */
static const uint8_t keys_bare[] = "\1c";
static const uint8_t keys_hello[] = "\1c\3min\3max\3bin";
static const uint8_t keys_describe[] = "\1c\3row";
static const uint8_t keys_drive[] = "\1c\1v\1w\3ttl\1n\1t";
static const uint8_t keys_motor[] = "\1c\5motor\10throttle\3ttl\1n\1t";
static const uint8_t keys_move[] = "\1c\6length\6radius\1n\1t";
static const uint8_t keys_beep[] = "\1c\5pitch\10duration\6volume";
static const uint8_t keys_led[] = "\1c\3led\7pattern\12brightness";
static const uint8_t keys_arm[] = "\1c\6undock\1n";
static const uint8_t keys_clear[] = "\1c\7inhibit\1n";
static const uint8_t keys_set[] = "\1c\4name\5value\1n";
static const uint8_t keys_ping[] = "\1c\1n";
static const uint8_t keys_charge[] = "\1c\2on\1n";
static const uint8_t keys_probe[] = "\1c\2of\4port\4baud\3ttl\1n";
static const uint8_t name_c[] = "\1c";
static const uint8_t name_n[] = "\1n";
static const uint8_t name_stop[] = "\4stop";
static const uint8_t patterns[] = "\3off\2on\5blink";
static const uint8_t targets[] = "\6analog\10encoders\5lines\7buttons\6serial";
static const uint8_t kinds[] = "\5state\5drive";

#define TARGET_SERIAL 4

/* What was found at the keys of the command. */
static struct cord_piece fields[KEYS_MAX];
/* Why the packet is refused: the first reason counts. */
static CORD_NEAR uint8_t refusal;
static CORD_NEAR uint8_t form;
static uint32_t tick_now;

static void refuse(uint8_t why) {
    if (refusal == 0) {
        refusal = why;
    }
}

/* The value of `c`, which usually is the first member, in `cord_value`; 0, or why there is none. */
static uint8_t find_word(void) {
    if (!cord_scan_begin()) {
        return CORD_REFUSAL_SYNTAX;
    }
    for (;;) {
        uint8_t scanned = cord_scan_next();
        if (scanned == CORD_SCAN_BROKEN) {
            return CORD_REFUSAL_SYNTAX;
        }
        if (scanned == CORD_SCAN_END) {
            return CORD_REFUSAL_MISSING;
        }
        if (cord_name_find(name_c, cord_key.at, cord_key.length) == 0) {
            return cord_value.kind == CORD_KIND_TEXT ? 0 : CORD_REFUSAL_SYNTAX;
        }
    }
}

/* Reads all members into `fields`. */
static void read_fields(const uint8_t *keys) {
    uint8_t index;
    for (index = 0; index < KEYS_MAX; index++) {
        fields[index].kind = CORD_KIND_ABSENT;
    }
    if (!cord_scan_begin()) {
        refuse(CORD_REFUSAL_SYNTAX);
        return;
    }
    for (;;) {
        uint8_t scanned = cord_scan_next();
        if (scanned != CORD_SCAN_MEMBER) {
            if (scanned == CORD_SCAN_BROKEN) {
                refuse(CORD_REFUSAL_SYNTAX);
            }
            return;
        }
        index = cord_name_find(keys, cord_key.at, cord_key.length);
        if (index == 0xFF) {
            continue;
        }
        if (fields[index].kind != CORD_KIND_ABSENT) {
            refuse(CORD_REFUSAL_DUPLICATE);
            return;
        }
        fields[index] = cord_value;
    }
}

/* The same for motion: a key that nobody knows is the typing error of a person. */
static void read_motion_fields(const uint8_t *keys) {
    uint8_t scanned;
    if (form == CORD_FORM_HAND && cord_scan_begin()) {
        uint8_t seen = 0;
        while ((scanned = cord_scan_next()) == CORD_SCAN_MEMBER) {
            uint8_t index = cord_name_find(keys, cord_key.at, cord_key.length);
            if (index == 0xFF) {
                refuse(CORD_REFUSAL_KEY);
                return;
            }
            if (seen & (uint8_t)(1 << index)) {
                break;
            }
            seen |= (uint8_t)(1 << index);
        }
    }
    read_fields(keys);
}

static uint8_t has(uint8_t index) {
    return fields[index].kind != CORD_KIND_ABSENT;
}

/* A value of this kind that must be there. */
static uint8_t need(uint8_t index, uint8_t kind) {
    if (!has(index)) {
        refuse(CORD_REFUSAL_MISSING);
        return 0;
    }
    if (fields[index].kind != kind) {
        refuse(CORD_REFUSAL_SYNTAX);
        return 0;
    }
    return refusal == 0;
}

/* A number that must be there. */
static uint32_t number(uint8_t index, uint8_t span) {
    if (!need(index, CORD_KIND_NUMBER)) {
        return 0;
    }
    if (!cord_number_read(fields[index].at, span)) {
        refuse(CORD_REFUSAL_RANGE);
        return 0;
    }
    return cord_number;
}

/* The place of a name that must be there. */
static uint8_t name(uint8_t index, const uint8_t *names) {
    uint8_t found = 0;
    if (need(index, CORD_KIND_TEXT)) {
        found = cord_name_find(names, fields[index].at, fields[index].length);
        if (found == 0xFF) {
            refuse(CORD_REFUSAL_UNKNOWN);
        }
    }
    return found;
}

static uint8_t flag(uint8_t index) {
    if (has(index) && fields[index].kind == CORD_KIND_FALSE) {
        return 0;
    }
    return need(index, CORD_KIND_TRUE);
}

/* A ratio that is 1 when absent. */
static int32_t ratio(uint8_t index) {
    return has(index) ? (int32_t)number(index, CORD_SPAN_RATIO) : MILLION;
}

static void read_number(uint8_t index) {
    if (form != CORD_FORM_CHECKED && !has(index)) {
        cord_command.number = 0;
    } else {
        cord_command.number = (uint16_t)number(index, CORD_SPAN_WORD);
    }
}

static void read_tick(uint8_t index) {
    if (form != CORD_FORM_CHECKED && !has(index)) {
        cord_command.tick = tick_now;
    } else {
        cord_command.tick = number(index, CORD_SPAN_TOTAL);
    }
}

/* Lease, number and tick at keys 3, 4 and 5. */
static void read_freshness(void) {
    if (form != CORD_FORM_CHECKED && !has(3)) {
        cord_command.lease_ms = LEASE_DEFAULT_MS;
    } else {
        cord_command.lease_ms = (uint16_t)number(3, CORD_SPAN_LEASE);
    }
    read_number(4);
    read_tick(5);
}

/* Kinds in a list of words; those of a newer peer are ignored. */
static uint8_t binary_kinds(uint8_t at, uint8_t length) {
    uint8_t found = 0;
    uint8_t begin = 0;
    uint8_t end;
    for (end = 0; end <= length; end++) {
        if (end == length || cord_packet[(uint8_t)(at + end)] == ' ') {
            uint8_t kind = cord_name_find(kinds, (uint8_t)(at + begin), (uint8_t)(end - begin));
            if (kind != 0xFF) {
                found |= (uint8_t)(1 << kind);
            }
            begin = (uint8_t)(end + 1);
        }
    }
    return found;
}

static void read_hello(void) {
    read_fields(keys_hello);
    cord_command.flag = 0;
    if (has(3) && need(3, CORD_KIND_TEXT)) {
        cord_command.flag = binary_kinds(fields[3].at, fields[3].length);
    }
    cord_command.what = (uint8_t)number(1, CORD_SPAN_BYTE);
    cord_command.detail = (uint8_t)number(2, CORD_SPAN_BYTE);
}

static void read_drive(void) {
    read_motion_fields(keys_drive);
    read_freshness();
    cord_command.value = (int32_t)number(1, CORD_SPAN_SPEED);
    cord_command.second = (int32_t)number(2, CORD_SPAN_TURN);
}

static void read_motor(void) {
    read_motion_fields(keys_motor);
    cord_command.value = (int32_t)number(2, CORD_SPAN_THROTTLE);
    read_freshness();
    cord_command.what = name(1, cord_names_motor);
}

static void read_move(void) {
    read_motion_fields(keys_move);
    if (fields[2].kind == CORD_KIND_NULL || (form != CORD_FORM_CHECKED && !has(2))) {
        cord_command.second = CORD_STRAIGHT;
    } else {
        cord_command.second = (int32_t)number(2, CORD_SPAN_MOVE_RADIUS);
    }
    cord_command.value = (int32_t)number(1, CORD_SPAN_MOVE_LENGTH);
    read_number(3);
    read_tick(4);
}

static void read_beep(void) {
    read_fields(keys_beep);
    cord_command.value = (int32_t)number(1, CORD_SPAN_PITCH);
    if (cord_command.value > 0 && cord_command.value < CORD_PITCH_LEAST_HZ) {
        refuse(CORD_REFUSAL_RANGE);
    }
    cord_command.lease_ms = (uint16_t)number(2, CORD_SPAN_DURATION);
    cord_command.second = ratio(3);
}

static void read_led(void) {
    read_fields(keys_led);
    cord_command.what = (uint8_t)number(1, CORD_SPAN_LED);
    cord_command.detail = name(2, patterns);
    cord_command.value = ratio(3);
}

static void read_set(void) {
    uint32_t least;
    uint32_t most;
    read_fields(keys_set);
    cord_command.what = name(1, cord_names_parameter);
    cord_command.value = (int32_t)number(2, CORD_SPAN_COUNT);
    if (refusal == 0) {
        least = cord_parameter_least[cord_command.what];
        most = cord_parameter_most[cord_command.what];
        if (cord_command.value != 0 &&
            (cord_command.value < (int32_t)least || cord_command.value > (int32_t)most)) {
            refuse(CORD_REFUSAL_RANGE);
        }
    }
    read_number(3);
}

static void read_probe(void) {
    read_fields(keys_probe);
    cord_command.what = name(1, targets);
    if (refusal == 0 && cord_command.what == TARGET_SERIAL) {
        cord_command.detail = (uint8_t)number(2, CORD_SPAN_BYTE);
        cord_command.value = (int32_t)number(3, CORD_SPAN_BAUD);
    }
    if (has(4)) {
        cord_command.lease_ms = (uint16_t)number(4, CORD_SPAN_PROBE_LEASE);
    } else {
        cord_command.lease_ms = cord_command.what == TARGET_SERIAL ? CORD_PROBE_LEASE_MS_MAX : 0;
    }
    if (cord_command.what == TARGET_SERIAL && cord_command.lease_ms == 0) {
        refuse(CORD_REFUSAL_RANGE);
    }
    read_number(5);
}

/* Commands with at most one key besides `c` and `n`. */
static void read_small(uint8_t command) {
    switch (command) {
    case CORD_COMMAND_DESCRIBE:
        read_fields(keys_describe);
        cord_command.what = (uint8_t)number(1, CORD_SPAN_BYTE);
        break;
    case CORD_COMMAND_ARM:
        read_fields(keys_arm);
        cord_command.flag = has(1) ? flag(1) : 0;
        read_number(2);
        break;
    case CORD_COMMAND_CLEAR:
        read_fields(keys_clear);
        cord_command.what = name(1, cord_names_inhibit);
        read_number(2);
        break;
    case CORD_COMMAND_PING:
        read_fields(keys_ping);
        read_number(1);
        break;
    case CORD_COMMAND_SEEN:
        read_fields(keys_ping);
        cord_command.number = (uint16_t)number(1, CORD_SPAN_WORD);
        break;
    case CORD_COMMAND_CHARGE:
        read_fields(keys_charge);
        cord_command.flag = flag(1);
        read_number(2);
        break;
    default:
        read_fields(keys_bare);
        break;
    }
}

uint8_t cord_command_read(uint8_t strictness, uint32_t now) {
    uint8_t command;
    refusal = find_word();
    if (refusal != 0) {
        return refusal;
    }
    command = cord_name_find(cord_names_command, cord_value.at, cord_value.length);
    if (command == 0xFF) {
        return CORD_REFUSAL_UNKNOWN;
    }
    form = strictness;
    tick_now = now;
    cord_command.name = command;
    switch (command) {
    case CORD_COMMAND_HELLO:
        read_hello();
        break;
    case CORD_COMMAND_DRIVE:
        read_drive();
        break;
    case CORD_COMMAND_MOTOR:
        read_motor();
        break;
    case CORD_COMMAND_MOVE:
        read_move();
        break;
    case CORD_COMMAND_BEEP:
        read_beep();
        break;
    case CORD_COMMAND_LED:
        read_led();
        break;
    case CORD_COMMAND_SET:
        read_set();
        break;
    case CORD_COMMAND_PROBE:
        read_probe();
        break;
    default:
        read_small(command);
        break;
    }
    return refusal;
}

/* A little-endian number of a binary body; `at` counts the kind. */
static uint16_t word_at(uint8_t at) {
    return (uint16_t)(cord_packet[at] | (uint16_t)((uint16_t)cord_packet[at + 1] << 8));
}

static uint32_t long_at(uint8_t at) {
    return word_at(at) | (uint32_t)word_at((uint8_t)(at + 2)) << 16;
}

static uint8_t is_within(int32_t value, int32_t most) {
    return value >= -most && value <= most;
}

uint8_t cord_command_read_drive(void) {
    if (cord_packet_length != CORD_DRIVE_BYTES + 1) {
        return CORD_REFUSAL_SYNTAX;
    }
    cord_command.name = CORD_COMMAND_DRIVE;
    cord_command.value = (int32_t)long_at(1);
    cord_command.second = (int32_t)long_at(5);
    cord_command.lease_ms = word_at(9);
    cord_command.number = word_at(11);
    cord_command.tick = long_at(13);
    if (!is_within(cord_command.value, CORD_SPEED_MOST) || !is_within(cord_command.second, CORD_TURN_MOST) ||
        cord_command.lease_ms < CORD_LEASE_LEAST || cord_command.lease_ms > CORD_LEASE_MOST) {
        return CORD_REFUSAL_RANGE;
    }
    return 0;
}

uint8_t cord_command_number(void) {
    if (!cord_scan_begin()) {
        return 0;
    }
    while (cord_scan_next() == CORD_SCAN_MEMBER) {
        if (cord_name_find(name_n, cord_key.at, cord_key.length) == 0) {
            return cord_value.kind == CORD_KIND_NUMBER && cord_number_read(cord_value.at, CORD_SPAN_WORD);
        }
    }
    return 0;
}

uint8_t cord_command_is_stop(void) {
    if (cord_packet_length == 4 && cord_name_find(name_stop, 0, 4) == 0) {
        return 1;
    }
    return find_word() == 0 && cord_name_find(name_stop, cord_value.at, cord_value.length) == 0;
}

uint8_t cord_command_is_pattern(void) {
    uint16_t at;
    for (at = 0; at < cord_packet_length; at++) {
        if (cord_packet[at] != CORD_BAUD_RATE_PATTERN) {
            return 0;
        }
    }
    return 1;
}

/* What the C cord and the Rust protocol must agree on. Made by cargo xtask codegen from protocol/rvac-protocol. Do not edit.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORD_WIRE_H
#define CORD_WIRE_H

#include <stdint.h>

#define CORD_PACKET_BYTES_MAX 256
#define CORD_SEPARATOR 31
#define CORD_SEPARATOR_2016 30
#define CORD_STUFFING 29
#define CORD_STUFFED_BIT 32
#define CORD_BINARY_KIND_MIN 128
#define CORD_KIND_DRIVE 129
#define CORD_KIND_STATE 130
#define CORD_DRIVE_BYTES 16
#define CORD_STATE_BYTES 50
#define CORD_VERSION_LEAST 1
#define CORD_VERSION_MOST 1
#define CORD_FRESHNESS_MS 400
#define CORD_SESSION_SILENCE_MS 2000
#define CORD_HAND_LEASE_MS_MAX 500
#define CORD_HAND_SPEED_MAX 100000
#define CORD_HAND_TURN_MAX 500000
#define CORD_PROBE_LEASE_MS_MAX 1000
#define CORD_BAUD_RATE_PATTERN 85
#define CORD_SPEED_MOST 2000000L
#define CORD_TURN_MOST 8000000L
#define CORD_LEASE_LEAST 1
#define CORD_LEASE_MOST 1000
#define CORD_PITCH_LEAST_HZ 20

#define CORD_COMMAND_HELLO 0
#define CORD_COMMAND_HAND 1
#define CORD_COMMAND_DESCRIBE 2
#define CORD_COMMAND_INFO 3
#define CORD_COMMAND_STATE 4
#define CORD_COMMAND_DRIVE 5
#define CORD_COMMAND_MOTOR 6
#define CORD_COMMAND_MOVE 7
#define CORD_COMMAND_STOP 8
#define CORD_COMMAND_BEEP 9
#define CORD_COMMAND_LED 10
#define CORD_COMMAND_ARM 11
#define CORD_COMMAND_CLEAR 12
#define CORD_COMMAND_SET 13
#define CORD_COMMAND_PING 14
#define CORD_COMMAND_SEEN 15
#define CORD_COMMAND_CHARGE 16
#define CORD_COMMAND_PROBE 17

#define CORD_MOTOR_WHEEL_LEFT 0
#define CORD_MOTOR_WHEEL_RIGHT 1
#define CORD_MOTOR_BRUSH_MAIN 2
#define CORD_MOTOR_BRUSH_SIDES 3
#define CORD_MOTOR_BRUSH_LEFT 4
#define CORD_MOTOR_BRUSH_RIGHT 5
#define CORD_MOTOR_VACUUM 6

#define CORD_INHIBIT_NOT_ARMED 0
#define CORD_INHIBIT_RESET_LOOP 1
#define CORD_INHIBIT_LINK_LOST 2
#define CORD_INHIBIT_BUMPER 3
#define CORD_INHIBIT_BUMPER_STUCK 4
#define CORD_INHIBIT_CLIFF 5
#define CORD_INHIBIT_CLIFF_TRAPPED 6
#define CORD_INHIBIT_CLIFF_SENSOR 7
#define CORD_INHIBIT_WHEEL_DROP 8
#define CORD_INHIBIT_WHEEL_STALL 9
#define CORD_INHIBIT_BRUSH_STALL 10
#define CORD_INHIBIT_RUNAWAY 11
#define CORD_INHIBIT_ENCODER 12
#define CORD_INHIBIT_NOT_MOVING 13
#define CORD_INHIBIT_DOCKED 14
#define CORD_INHIBIT_BUTTON_STOP 15
#define CORD_INHIBIT_STOPPED 16
#define CORD_INHIBIT_INTERNAL 17
#define CORD_INHIBIT_BATTERY_LOW 18
#define CORD_INHIBIT_BATTERY_WEAK 19
#define CORD_INHIBIT_BATTERY_EMPTY 20
#define CORD_INHIBIT_BATTERY_HOT 21
#define CORD_INHIBIT_BATTERY_OVERHEATED 22
#define CORD_INHIBIT_THERMISTOR 23
#define CORD_INHIBIT_CHARGER_FAULT 24
#define CORD_INHIBIT_CHARGER_SHORTED 25
#define CORD_INHIBIT_CLOCK 26
#define CORD_INHIBIT_MEMORY 27

#define CORD_PARAMETER_STATE_MS 0
#define CORD_PARAMETER_INFO_MS 1

#define CORD_REFUSAL_RANGE 1
#define CORD_REFUSAL_MISSING 2
#define CORD_REFUSAL_DUPLICATE 3
#define CORD_REFUSAL_KEY 4
#define CORD_REFUSAL_UNKNOWN 5
#define CORD_REFUSAL_UNSEALED 6
#define CORD_REFUSAL_OLD 7
#define CORD_REFUSAL_STALE 8
#define CORD_REFUSAL_INHIBITED 9
#define CORD_REFUSAL_ABSENT 10
#define CORD_REFUSAL_BUSY 11
#define CORD_REFUSAL_CAUSE_REMAINS 12
#define CORD_REFUSAL_SYNTAX 13

#define CORD_ARMING_LOCKED 0
#define CORD_ARMING_ARMED 1
#define CORD_ARMING_LEAVING_DOCK 2
#define CORD_ARMING_HAND 3
#define CORD_ARMING_DOCK_ESCAPE 4

#define CORD_SPAN_SPEED 0
#define CORD_SPAN_TURN 1
#define CORD_SPAN_LEASE 2
#define CORD_SPAN_PROBE_LEASE 3
#define CORD_SPAN_BAUD 4
#define CORD_SPAN_THROTTLE 5
#define CORD_SPAN_MOVE_LENGTH 6
#define CORD_SPAN_MOVE_RADIUS 7
#define CORD_SPAN_PITCH 8
#define CORD_SPAN_DURATION 9
#define CORD_SPAN_RATIO 10
#define CORD_SPAN_LED 11
#define CORD_SPAN_BYTE 12
#define CORD_SPAN_WORD 13
#define CORD_SPAN_TOTAL 14
#define CORD_SPAN_COUNT 15

/* Names, each with its length before it and 0 at the end. */
extern const uint8_t cord_names_command[];
extern const uint8_t cord_names_motor[];
extern const uint8_t cord_names_inhibit[];
extern const uint8_t cord_names_parameter[];
extern const uint8_t cord_names_refusal[];
extern const uint8_t cord_names_arming[];

/* Ranges: decimals, greatest magnitude below zero, least and most from zero on. */
extern const uint8_t cord_span_decimals[];
extern const uint32_t cord_span_below[];
extern const uint32_t cord_span_least[];
extern const uint32_t cord_span_most[];

/* Ranges of parameters besides 0. */
extern const uint32_t cord_parameter_least[];
extern const uint32_t cord_parameter_most[];

#endif

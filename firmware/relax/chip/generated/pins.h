/* Pins of the board. Made by cargo xtask codegen from robots/vileda-relax/pinout.toml. Do not edit.
 *
 * For each signal: a bit variable; _PORT and _MASK for those that are read together; and, where somebody knows
 * it, _ACTIVE, the level that means what the name says. */
#ifndef PINS_H
#define PINS_H

/* P1.3, package pin 4, output: right wheel, backward; never low together with wheel-right-forward: the type of the bridge is not known. */
__sbit __at(0x93) WHEEL_RIGHT_BACKWARD;
#define WHEEL_RIGHT_BACKWARD_PORT P1
#define WHEEL_RIGHT_BACKWARD_MASK 0x08
#define WHEEL_RIGHT_BACKWARD_ACTIVE 0

/* P1.4, package pin 5, output: right wheel, forward. */
__sbit __at(0x94) WHEEL_RIGHT_FORWARD;
#define WHEEL_RIGHT_FORWARD_PORT P1
#define WHEEL_RIGHT_FORWARD_MASK 0x10
#define WHEEL_RIGHT_FORWARD_ACTIVE 0

/* P2.0, package pin 21, output: left wheel, backward; never low together with wheel-left-forward. */
__sbit __at(0xA0) WHEEL_LEFT_BACKWARD;
#define WHEEL_LEFT_BACKWARD_PORT P2
#define WHEEL_LEFT_BACKWARD_MASK 0x01
#define WHEEL_LEFT_BACKWARD_ACTIVE 0

/* P2.1, package pin 22, output: left wheel, forward. */
__sbit __at(0xA1) WHEEL_LEFT_FORWARD;
#define WHEEL_LEFT_FORWARD_PORT P2
#define WHEEL_LEFT_FORWARD_MASK 0x02
#define WHEEL_LEFT_FORWARD_ACTIVE 0

/* P0.4, package pin 35, input: one line, so no direction; polled. */
__sbit __at(0x84) ENCODER_LEFT;
#define ENCODER_LEFT_PORT P0
#define ENCODER_LEFT_MASK 0x10
#define ENCODER_LEFT_ACTIVE 0

/* P0.0, package pin 39, input: one line, so no direction; polled. */
__sbit __at(0x80) ENCODER_RIGHT;
#define ENCODER_RIGHT_PORT P0
#define ENCODER_RIGHT_MASK 0x01
#define ENCODER_RIGHT_ACTIVE 0

/* P2.6, package pin 27, input: threshold not known. */
__sbit __at(0xA6) WHEEL_LEFT_OVER_CURRENT;
#define WHEEL_LEFT_OVER_CURRENT_PORT P2
#define WHEEL_LEFT_OVER_CURRENT_MASK 0x40
#define WHEEL_LEFT_OVER_CURRENT_ACTIVE 0

/* P1.1, package pin 2, input: threshold not known; this pin is also T2EX, so EXEN2 must stay 0. */
__sbit __at(0x91) WHEEL_RIGHT_OVER_CURRENT;
#define WHEEL_RIGHT_OVER_CURRENT_PORT P1
#define WHEEL_RIGHT_OVER_CURRENT_MASK 0x02
#define WHEEL_RIGHT_OVER_CURRENT_ACTIVE 0

/* P1.7, package pin 8, input: low when any of the three wheels hangs; the original's header calls it the right wheel's, its author's pin table is right. */
__sbit __at(0x97) WHEEL_DROP;
#define WHEEL_DROP_PORT P1
#define WHEEL_DROP_MASK 0x80
#define WHEEL_DROP_ACTIVE 0

/* P2.5, package pin 26, output: main brush. */
__sbit __at(0xA5) BRUSH_MAIN;
#define BRUSH_MAIN_PORT P2
#define BRUSH_MAIN_MASK 0x20
#define BRUSH_MAIN_ACTIVE 0

/* P2.4, package pin 25, input: threshold not known. */
__sbit __at(0xA4) BRUSH_MAIN_OVER_CURRENT;
#define BRUSH_MAIN_OVER_CURRENT_PORT P2
#define BRUSH_MAIN_OVER_CURRENT_MASK 0x10
#define BRUSH_MAIN_OVER_CURRENT_ACTIVE 0

/* P1.6, package pin 7, output: suction and side brush, one line for both. */
__sbit __at(0x96) SUCTION;
#define SUCTION_PORT P1
#define SUCTION_MASK 0x40
#define SUCTION_ACTIVE 0

/* P1.5, package pin 6, input: suction and side brush; threshold not known. */
__sbit __at(0x95) SUCTION_OVER_CURRENT;
#define SUCTION_OVER_CURRENT_PORT P1
#define SUCTION_OVER_CURRENT_MASK 0x20
#define SUCTION_OVER_CURRENT_ACTIVE 0

/* P2.7, package pin 28, output: emitters of bumper, floor and wall sensors; the maker drives them with 2 kHz, 20 % low. */
__sbit __at(0xA7) SENSOR_LIGHT;
#define SENSOR_LIGHT_PORT P2
#define SENSOR_LIGHT_MASK 0x80
#define SENSOR_LIGHT_ACTIVE 0

/* P2.2, package pin 23, input: light barrier: low = not pressed, also pressed when its light is off; the original's header has it as an unknown left sensor. */
__sbit __at(0xA2) BUMPER_LEFT;
#define BUMPER_LEFT_PORT P2
#define BUMPER_LEFT_MASK 0x04
#define BUMPER_LEFT_ACTIVE 1

/* P1.0, package pin 1, input: light barrier: low = not pressed; this pin is also T2, so timer 2 must not put out its clock. */
__sbit __at(0x90) BUMPER_RIGHT;
#define BUMPER_RIGHT_PORT P1
#define BUMPER_RIGHT_MASK 0x01
#define BUMPER_RIGHT_ACTIVE 1

/* P0.7, package pin 32, input: high = floor; no light, a covered receiver or a broken line reads as no floor. */
__sbit __at(0x87) FLOOR_LEFT_OUTER;
#define FLOOR_LEFT_OUTER_PORT P0
#define FLOOR_LEFT_OUTER_MASK 0x80
#define FLOOR_LEFT_OUTER_ACTIVE 1

/* P0.6, package pin 33, input: high = floor. */
__sbit __at(0x86) FLOOR_LEFT_INNER;
#define FLOOR_LEFT_INNER_PORT P0
#define FLOOR_LEFT_INNER_MASK 0x40
#define FLOOR_LEFT_INNER_ACTIVE 1

/* P0.3, package pin 36, input: high = floor. */
__sbit __at(0x83) FLOOR_RIGHT_INNER;
#define FLOOR_RIGHT_INNER_PORT P0
#define FLOOR_RIGHT_INNER_MASK 0x08
#define FLOOR_RIGHT_INNER_ACTIVE 1

/* P0.1, package pin 38, input: high = floor. */
__sbit __at(0x81) FLOOR_RIGHT_OUTER;
#define FLOOR_RIGHT_OUTER_PORT P0
#define FLOOR_RIGHT_OUTER_MASK 0x02
#define FLOOR_RIGHT_OUTER_ACTIVE 1

/* P0.2, package pin 37, input: high = near a wall, right side. */
__sbit __at(0x82) WALL;
#define WALL_PORT P0
#define WALL_MASK 0x04
#define WALL_ACTIVE 1

/* P1.2, package pin 3, input: low = the battery is OK; what decides that is not known. */
__sbit __at(0x92) BATTERY_OK;
#define BATTERY_OK_PORT P1
#define BATTERY_OK_MASK 0x04
#define BATTERY_OK_ACTIVE 0

/* P2.3, package pin 24, output: coupled by a capacitor: it wants a square wave, and no level lasts. */
__sbit __at(0xA3) SPEAKER;
#define SPEAKER_PORT P2
#define SPEAKER_MASK 0x08
#define SPEAKER_ACTIVE 0

/* P3.0, package pin 10, input: connector pin 1; once LED 3 of the button board, whose 10 k pull it up; low = a bit that is 0. */
__sbit __at(0xB0) LINK_RECEIVE;
#define LINK_RECEIVE_PORT P3
#define LINK_RECEIVE_MASK 0x01
#define LINK_RECEIVE_ACTIVE 0

/* P3.1, package pin 11, output: connector pin 4; once button 3; must be high for the UART to send; low = a bit that is 0. */
__sbit __at(0xB1) LINK_TRANSMIT;
#define LINK_TRANSMIT_PORT P3
#define LINK_TRANSMIT_MASK 0x02
#define LINK_TRANSMIT_ACTIVE 0

/* P3.2, package pin 12, spare: connector pin 7; the button hangs on the Linux board. */
__sbit __at(0xB2) BUTTON_2;
#define BUTTON_2_PORT P3
#define BUTTON_2_MASK 0x04

/* P3.3, package pin 13, spare: connector pin 8; the button hangs on the Linux board. */
__sbit __at(0xB3) BUTTON_1;
#define BUTTON_1_PORT P3
#define BUTTON_1_MASK 0x08

/* P3.4, package pin 14, spare: connector pin 5; the lights hang on the Linux board. */
__sbit __at(0xB4) LED_OK;
#define LED_OK_PORT P3
#define LED_OK_MASK 0x10
#define LED_OK_ACTIVE 0

/* P3.5, package pin 15, spare: connector pin 6; what this light means is not known. */
__sbit __at(0xB5) LED_UNKNOWN;
#define LED_UNKNOWN_PORT P3
#define LED_UNKNOWN_MASK 0x20
#define LED_UNKNOWN_ACTIVE 0

/* P3.6, package pin 16, spare: connector pin 9; the light hangs on the Linux board. */
__sbit __at(0xB6) LED_2;
#define LED_2_PORT P3
#define LED_2_MASK 0x40
#define LED_2_ACTIVE 0

/* P3.7, package pin 17, spare: connector pin 10; the light hangs on the Linux board. */
__sbit __at(0xB7) LED_1;
#define LED_1_PORT P3
#define LED_1_MASK 0x80
#define LED_1_ACTIVE 0

/* P0.5, package pin 34, spare: middle pin of a service port; the one free pin. */
__sbit __at(0x85) SERVICE;
#define SERVICE_PORT P0
#define SERVICE_MASK 0x20

/* What start-up writes to the ports before anything else: outputs safe, inputs let go. */
#define P0_START 0xFF
#define P1_START 0xFF
#define P2_START 0xFF
#define P3_START 0xFF

#endif

/* C interface of cordlib. Written by `cargo run -p cordlib-c --bin generate-header`; do not edit.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORDLIB_H
#define CORDLIB_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Time in seconds since reset. Cordlib takes milliseconds from it if there is no callback for them. */
void set_callback_get_time(double (*callback)(void));

/* Time in milliseconds since reset, modulo 2^32. */
void set_callback_get_time_ms(uint32_t (*callback)(void));

/* Called once by cord_init and cord_event_init, before anything else. */
void set_callback_setup(void (*callback)(void));

/* Called before every pass of the main loop: the place to read pins and to push events. */
void set_callback_step(void (*callback)(void));

/* Sets a motor (CORD_MOTOR_...) to a duty of -1..1. Wheels at 0 are to brake. */
void set_callback_set_motor_throttle(void (*callback)(int32_t motor, double throttle));

/* Starts a tone of this pitch (Hz) and volume (0..1); pitch 0 is silence. */
void set_callback_beep(void (*callback)(double pitch, double volume));

/* Sets a light to a brightness of 0..1. */
void set_callback_led(void (*callback)(int32_t led, double brightness));

/* Switches the emitters of the cliff sensors on (1) or off (0), for the self-test. */
void set_callback_cliff_emitters(void (*callback)(int32_t on));

/* Feeds the hardware watchdog. Called only when clock, loop and communication are alive. */
void set_callback_feed_watchdog(void (*callback)(void));

/* Words of memory that a reset must leave alone, for latched inhibits and clocks: two copies of a record, each with its
 * check, written one after the other. */
#define CORD_KEPT_WORDS 36

/* Writes one word, 0 to CORD_KEPT_WORDS - 1, to memory that a reset leaves alone. Called for all words in order, at most
 * once a millisecond. Without this callback and the next one the record lives as long as the process. */
void set_callback_keep(void (*callback)(int32_t place, uint32_t word));

/* Reads back one word of that memory; called by cord_init. It may hold anything after power-on. */
void set_callback_kept(uint32_t (*callback)(int32_t place));

/* Names the device and the firmware's version, each at most 24 bytes of UTF-8, ended by NUL. Returns 1, or 0 if a name
 * is NULL or no UTF-8. The names are copied. */
int32_t cord_set_names(const char *device, const char *firmware);

/* Sets the highest speed in m/s and turn rate in rad/s. Returns 1, or 0 for a value that is not above 0 or not finite. */
int32_t cord_set_limits(double speed, double turn);

/* Sets the distance between the wheels (m), the distance of the rim per encoder count (m), the duty below which a
 * wheel does not turn (0..1) and the speed at full duty (m/s). Returns 1, or 0 for a value out of range. */
int32_t cord_set_wheels(double track, double distance_per_count, double dead_band, double speed_at_full);

/* Sets the currents in A above which a wheel, and the main brush, is switched off after 100 ms (S11): some three quarters of
 * what the motor draws when it is held. At first they are 1.5 A and 2 A. Returns 1, or 0 for a value that is not above 0 or not
 * finite. */
int32_t cord_set_stall_limits(double wheel, double brush_main);

/* Declares how many of a part the machine has: "bumpers" (0..2), "cliffs" (0..3, from the left), "wheel-drops" (0..2),
 * "gyro", "buttons" (0..8), "leds" (0..16), "beeper", "brush-main", "brush-sides", "vacuum", "currents", "battery"
 * (0..1). What is not declared is absent. Wheels with encoders are always present. Returns 1, or 0 for another name or
 * number. */
int32_t cord_declare(const char *part, int32_t count);

/* Allows (1, as it is at first) or forbids (0) that a person arms the robot by packets without a session. Returns 1, or
 * 0 for another number. */
int32_t cord_set_hand_mode(int32_t allowed);

/* Sets how often the chip has started, and the number of consecutive recent resets. Three of them inhibit motion. */
void cord_set_resets(uint32_t boot_count, uint8_t recent_resets);

/* Calls the setup callback, switches all motors off and starts again, as after a reset: what is latched stays. Returns 1, or 0 when called
 * from inside a callback of the main loop. */
int32_t cord_init(void);

/* Calls the step callback, then does one pass of the main loop. Returns 1, or 0 before cord_init and inside of
 * callbacks. */
int32_t cord_step(void);

/* Initialises and runs the main loop until cord_event_exit is called from one of its callbacks; on a robot without
 * end. */
void cord_event_init(void);

/* Ends cord_event_init after the present pass, with all motors off. */
void cord_event_exit(void);

/* Switches everything off at once and latches "internal": for the fault handlers of the chip. A fault whose cause stands
 * is reported by cord_event_hardware_fault. Called from inside a
 * callback it switches the motors off without the latch. */
void cord_hardware_fault(void);

/* Seconds since reset, from the callback of set_callback_get_time, else from the one for milliseconds, else 0. A
 * callback that returns NaN or an infinity counts as 0. */
double hw_get_time(void);

/* Milliseconds since reset, modulo 2^32, from the callback of set_callback_get_time_ms, else from the one for seconds,
 * else 0. */
uint32_t hw_get_time_ms(void);

/* Puts one received byte into the input queue. Returns 1, or 0 if the queue was full: then the byte is lost, and the
 * main loop is informed. */
int32_t cord_connection_input_put(uint8_t byte);

/* The receiver saw a byte with a wrong stop bit. Returns as cord_connection_input_put. */
int32_t cord_connection_input_framing_error(void);

/* The receiver lost bytes. Returns as cord_connection_input_put. */
int32_t cord_connection_input_overrun(void);

/* Takes the next byte to send, 0 to 255, or -1 if there is none. */
int32_t cord_connection_output_pull(void);

/* Bytes that wait to be sent. */
int32_t cord_connection_output_length(void);

/* A bumper was pressed (1) or released (0) at this angle in radians, left positive: above 0 the left half, below 0 the
 * right half, 0 both. NaN counts as both. */
void cord_event_bumper(double angle, int32_t pressed);

/* Light that a cliff receiver sees, 0 (dark) to 1 (saturated), with the emitters as they are: sensor 0 left, 1 middle,
 * 2 right. NaN counts as dark, which is no floor. */
void cord_event_cliff(int32_t sensor, double level);

/* A wheel hangs (1) or is on the floor (0): wheel 0 left, 1 right. */
void cord_event_wheel_drop(int32_t wheel, int32_t hanging);

/* Totals of the wheel encoders, forward positive, wrapping. */
void cord_event_encoders(int32_t left, int32_t right);

/* A button, 0 to 7, is down (1) or up (0). */
void cord_event_button(int32_t button, int32_t down);

/* The dock's contacts are closed (1) or open (0). */
void cord_event_dock(int32_t closed);

/* Heading since reset in radians, counter-clockwise positive, and rate in rad/s. A NaN in either means that the gyro
 * has no reading now. */
void cord_event_gyro(double heading, double rate);

/* Motor currents in amperes. A NaN in any means that there are no readings. */
void cord_event_currents(double wheel_left, double wheel_right, double brush_main);

/* Battery: volts, amperes into the pack, degrees Celsius. A NaN in any means that there are no readings. Call it at least once
 * a second: a reading older than 2 s is none, and S17 then forbids motion. */
void cord_event_battery(double voltage, double current, double temperature);

/* The clock fails, or two clocks disagree. */
#define CORD_FAULT_CLOCK 0

/* Flash, memory or stack failed a check. */
#define CORD_FAULT_MEMORY 1

/* Any other self-check failed. */
#define CORD_FAULT_INTERNAL 2

/* The cause of a hardware fault (CORD_FAULT_...) is present (1) or gone (0). While it is present everything is off, its
 * inhibit is latched, and cord_clear refuses it. Another number counts as CORD_FAULT_INTERNAL. */
void cord_event_hardware_fault(int32_t fault, int32_t present);

/* Left wheel. */
#define CORD_MOTOR_WHEEL_LEFT 0

/* Right wheel. */
#define CORD_MOTOR_WHEEL_RIGHT 1

/* Main brush. */
#define CORD_MOTOR_BRUSH_MAIN 2

/* Both side brushes. */
#define CORD_MOTOR_BRUSH_SIDES 3

/* Suction. */
#define CORD_MOTOR_VACUUM 4

/* Done. */
#define CORD_OK 0

/* A number is out of range, not finite, or a name is not known. */
#define CORD_RANGE 1

/* Something inhibits; cord_inhibits shows what. */
#define CORD_INHIBITED 2

/* The machine has no such part. */
#define CORD_ABSENT 3

/* A queue is full. */
#define CORD_BUSY 4

/* The cause of the latched inhibit, or the button that stopped the robot, is still there. */
#define CORD_CAUSE_REMAINS 5

/* Not initialised, or called from inside a callback of the main loop. */
#define CORD_NOT_NOW 6

/* Sets the speeds of the left and right rim in m/s for the next 250 ms. Repeat it to continue. Returns CORD_OK or why
 * not. */
int32_t cord_set_speed_goal(double left, double right);

/* Sets the duty of a cleaning motor or wheel (CORD_MOTOR_...), -1..1, for the next 250 ms; brushes and suction run 2
 * s. Returns CORD_OK or why not. */
int32_t cord_set_motor_goal(int32_t motor, double throttle);

/* Allows motion; on the dock only with undock = 1. Without a host's session it ends 10 s after the last goal. Returns
 * CORD_OK or why not. */
int32_t cord_arm(int32_t undock);

/* Stops everything until cord_arm or an arming host. Returns CORD_OK or CORD_NOT_NOW. */
int32_t cord_stop(void);

/* Clears a latched inhibit by its name on the wire, for example "bumper-stuck". Returns CORD_OK or why not. */
int32_t cord_clear(const char *inhibit);

/* Queues a tone of a pitch in Hz (0 = pause), a duration in seconds (0.001..10) and a volume (0..1). Returns CORD_OK
 * or why not. */
int32_t cord_beep(double pitch, double duration, double volume);

/* Sets a light: pattern 0 off, 1 on, 2 blinking once a second; brightness 0..1. Returns CORD_OK or why not. */
int32_t cord_led(int32_t led, int32_t pattern, double brightness);

/* Everything that inhibits motion, as the bits of the wire: bit 0 not-armed, 3 bumper, 5 cliff, 8 wheel-drop ... All
 * bits are set while that is not known. */
uint32_t cord_inhibits(void);

#ifdef __cplusplus
}
#endif

#endif /* CORDLIB_H */

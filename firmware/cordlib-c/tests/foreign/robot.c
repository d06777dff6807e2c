/* A whole exchange through the C interface: a person's typed packets go in, throttles and packets with a CRC come out.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "cordlib.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SEPARATOR 0x1F
#define PACKETS 64
#define PACKET_BYTES 600

static double now_s = 4294966.0;
static double throttles[5];
static double way_m[2];
static int steps, setups, feedings, failures;
static double tone_hz;
static uint32_t memory[CORD_KEPT_WORDS];
static char packets[PACKETS][PACKET_BYTES];
static int packet_count, packet_length;

static double get_time(void) { return now_s; }
static double get_nan(void) { return NAN; }
static uint32_t get_time_ms(void) { return 1234567; }
static void setup(void) { setups++; }
static void feed(void) { feedings++; }
static void beep(double pitch, double volume) { tone_hz = volume > 0 ? pitch : 0; }

static void keep(int32_t place, uint32_t word) { memory[place] = word; }
static uint32_t kept(int32_t place) { return memory[place]; }

static void set_motor_throttle(int32_t motor, double throttle)
{
    if (motor >= 0 && motor < 5)
        throttles[motor] = throttle;
}

/* Wheels that follow their throttle at once, and a floor that answers to nothing: no cliff sensor is declared. */
static void step(void)
{
    steps++;
    for (int wheel = 0; wheel < 2; wheel++)
        way_m[wheel] += throttles[wheel] * 0.4e-3;
    cord_event_encoders((int32_t)(way_m[0] / 0.0005), (int32_t)(way_m[1] / 0.0005));
    if (cord_step() != 0)
        failures += printf("not ok - a callback entered the main loop\n") > 0;
}

static void check(int condition, const char *what)
{
    printf("%s - %s\n", condition ? "ok" : "not ok", what);
    failures += !condition;
}

static uint32_t crc32c(uint32_t crc, const unsigned char *bytes, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1 ? crc >> 1 ^ 0x82F63B78u : crc >> 1;
    }
    return crc;
}

/* Whether a text packet from the robot outside of a session carries the right CRC; the CRC is cut off. */
static int strip_crc(char *packet)
{
    char *star = strrchr(packet, '*');
    unsigned expected;
    if (!star || strlen(star) != 9 || sscanf(star + 1, "%8X", &expected) != 1)
        return 0;
    *star = 0;
    size_t length = strlen(packet);
    unsigned char head[3] = {'<', 0, 0};
    unsigned char tail[2] = {length & 0xFF, length >> 8};
    uint32_t crc = crc32c(0xFFFFFFFFu, head, sizeof head);
    crc = crc32c(crc, (unsigned char *)packet, length);
    crc = crc32c(crc, tail, sizeof tail);
    return (crc ^ 0xFFFFFFFFu) == expected;
}

static void pull(void)
{
    int byte;
    while ((byte = cord_connection_output_pull()) >= 0) {
        if (byte == SEPARATOR) {
            if (packet_length > 0 && packet_count < PACKETS) {
                packets[packet_count][packet_length] = 0;
                check(strip_crc(packets[packet_count]), packets[packet_count]);
                packet_count++;
            }
            packet_length = 0;
        } else if (packet_count < PACKETS && packet_length < PACKET_BYTES - 1) {
            packets[packet_count][packet_length++] = (char)byte;
        }
    }
}

static void run(int milliseconds)
{
    for (int i = 0; i < milliseconds; i++) {
        now_s += 0.001;
        if (!cord_step())
            failures += printf("not ok - a pass was refused\n") > 0;
        pull();
    }
}

static void type(const char *packet)
{
    for (; *packet; packet++)
        cord_connection_input_put((uint8_t)*packet);
    cord_connection_input_put(SEPARATOR);
    run(20);
}

static int said(const char *words)
{
    for (int i = 0; i < packet_count; i++)
        if (strstr(packets[i], words))
            return 1;
    return 0;
}

static void check_clock(void)
{
    set_callback_get_time(NULL);
    check(hw_get_time() == 0 && hw_get_time_ms() == 0, "no callback, no time");
    set_callback_get_time(get_nan);
    check(hw_get_time() == 0 && hw_get_time_ms() == 0, "NaN is no time");
    set_callback_get_time(get_time);
    check(hw_get_time() == now_s, "get_time() callback works");
    check(hw_get_time_ms() == 4294966000u, "milliseconds come from seconds");
    set_callback_get_time_ms(get_time_ms);
    check(hw_get_time_ms() == 1234567, "get_time_ms() callback works");
    set_callback_get_time_ms(NULL);
}

static void check_machine(void)
{
    check(cord_step() == 0, "nothing runs before cord_init");
    check(cord_set_names("c-test", "1.2") == 1, "names are taken");
    check(cord_set_names(NULL, "1.2") == 0, "NULL is no name");
    check(cord_set_limits(NAN, 1) == 0, "NaN is no limit");
    check(cord_set_limits(0.35, 1.5) == 1, "limits are taken");
    check(cord_set_wheels(0.23, 0.0005, 0.1, 0.4) == 1, "wheels are taken");
    check(cord_set_wheels(0.23, -1, 0.1, 0.4) == 0, "a negative way is refused");
    check(cord_declare("bumpers", 2) && cord_declare("beeper", 1), "parts are declared");
    check(cord_declare("bumper", 2) == 0, "names match exactly");
    check(cord_set_stall_limits(0.5, 0) == 0 && cord_set_stall_limits(NAN, 1) == 0, "no stall limit");
    check(cord_set_stall_limits(0.5, 0.8) == 1 && cord_declare("currents", 1), "stall limits are taken");
    check(cord_set_limits(0.35, 1.5) == 1, "and outlast a new speed");
    check(cord_set_hand_mode(1) == 1 && cord_set_hand_mode(2) == 0, "hand mode is allowed or not");
}

/* A wheel that draws more than the limit that was set is off after 100 ms. */
static void check_stall(void)
{
    const uint32_t stall_bit = 1u << 9;
    check(cord_arm(0) == CORD_OK, "armed again");
    cord_event_currents(0.45, 0.1, 0);
    for (int i = 0; i < 3; i++) {
        check(cord_set_speed_goal(0.1, 0.1) == CORD_OK, "drives below the limit");
        run(100);
    }
    check(!(cord_inhibits() & stall_bit), "a current below the limit is none of a stall");
    cord_event_currents(0.55, 0.1, 0);
    cord_set_speed_goal(0.1, 0.1);
    run(110);
    check((cord_inhibits() & stall_bit) && throttles[0] == 0, "above it the wheel is off");
    cord_event_currents(0, 0, 0);
    run(20);
    check(cord_clear("wheel-stall") == CORD_OK, "and a person clears it");
}

/* A fault that stands cannot be cleared, and cord_init, which is a reset, does not take it away. */
static void check_latches(void)
{
    const uint32_t memory_bit = 1u << 27;
    set_callback_step(NULL);
    set_callback_keep(keep);
    set_callback_kept(kept);
    check(cord_init() == 1, "starts with callbacks for its memory");
    cord_event_hardware_fault(CORD_FAULT_MEMORY, 1);
    run(2);
    check(cord_inhibits() & memory_bit, "a fault that stands is latched");
    check(cord_clear("memory") == CORD_CAUSE_REMAINS, "and cannot be cleared");
    cord_event_hardware_fault(CORD_FAULT_MEMORY, 0);
    run(2);
    check(cord_init() == 1 && (cord_inhibits() & memory_bit), "a reset keeps it");
    memory[0] ^= 4;
    check(cord_init() == 1 && (cord_inhibits() & memory_bit), "one damaged copy costs nothing");
    check(cord_clear("memory") == CORD_OK && !(cord_inhibits() & memory_bit), "it is cleared by a person");
    run(2);
    check(cord_init() == 1 && !(cord_inhibits() & memory_bit), "for good");
}

int main(void)
{
    check_clock();
    check_machine();
    set_callback_setup(setup);
    set_callback_step(step);
    set_callback_set_motor_throttle(set_motor_throttle);
    set_callback_beep(beep);
    set_callback_feed_watchdog(feed);
    check(cord_init() == 1 && setups == 1, "cord_init calls setup");

    run(100);
    check(said("\"hello\"") && said("c-test"), "the robot says hello");
    check(steps == 100 && feedings > 90, "step and watchdog callbacks are called");
    check(cord_inhibits() == 1, "not armed");
    check(cord_set_speed_goal(0.1, 0.1) == CORD_INHIBITED, "no motion before arming");

    type("{\"c\":\"arm\",\"n\":1,\"undock\":false}");
    check(said("\"a\":1"), "arming is answered");
    check(cord_inhibits() == 0, "armed");
    type("{\"c\":\"drive\",\"v\":0.05,\"w\":0,\"ttl\":500}");
    run(200);
    check(throttles[0] > 0.1 && throttles[1] > 0.1, "a typed drive turns both wheels");
    cord_event_bumper(0.5, 1);
    run(2);
    check(throttles[0] == 0 && throttles[1] == 0, "a bump stops them at once");
    run(100);
    check(said("\"bump\""), "the bump is reported");
    cord_event_bumper(0.5, 0);
    run(50);

    check(cord_set_speed_goal(NAN, 0) == CORD_RANGE, "NaN is no speed");
    check(cord_set_speed_goal(0.1, -0.1) == CORD_INHIBITED, "who types has armed for nobody else");
    check(cord_arm(0) == CORD_OK, "the firmware arms for itself");
    check(cord_set_speed_goal(0.1, -0.1) == CORD_OK, "the firmware's own goal");
    run(150);
    check(throttles[0] > 0 && throttles[1] < 0, "turns on the spot");
    run(200);
    check(throttles[0] == 0 && throttles[1] == 0, "and ends with its lease");
    cord_event_bumper(NAN, 1);
    run(2);
    check(cord_set_speed_goal(0.1, -0.1) == CORD_INHIBITED, "an unknown angle counts as both sides");
    cord_event_bumper(NAN, 0);
    check(cord_set_motor_goal(CORD_MOTOR_VACUUM, 1) == CORD_ABSENT, "what is not declared is absent");
    check(cord_beep(880, 0.05, 1) == CORD_OK && cord_beep(NAN, 1, 1) == CORD_RANGE, "beeps");
    run(10);
    check(tone_hz == 880, "a tone sounds");
    check(cord_stop() == CORD_OK && tone_hz == 0, "stop silences");
    check(cord_clear("no-such-thing") == CORD_RANGE && cord_clear(NULL) == CORD_RANGE, "unknown inhibit");

    check_stall();
    set_callback_step(cord_event_exit);
    cord_event_init();
    check(setups == 2, "cord_event_init returns after cord_event_exit");
    check_latches();
    return failures != 0;
}

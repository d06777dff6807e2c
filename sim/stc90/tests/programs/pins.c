/* The generated pins of the Relax: outputs by name, inputs by name, and whole ports by mask. */
#include <8052.h>
#include "pins.h"

__xdata __at(0x0200) unsigned char results[8];

void main(void)
{
    P0 = P0_START;
    P1 = P1_START;
    P2 = P2_START;
    P3 = P3_START;
    results[0] = P0 & P1 & P2 & P3;
    SENSOR_LIGHT = SENSOR_LIGHT_ACTIVE;
    WHEEL_LEFT_FORWARD = WHEEL_LEFT_FORWARD_ACTIVE;
    WHEEL_RIGHT_BACKWARD = WHEEL_RIGHT_BACKWARD_ACTIVE;
    results[1] = BUMPER_LEFT == BUMPER_LEFT_ACTIVE;
    results[2] = BUMPER_RIGHT == BUMPER_RIGHT_ACTIVE;
    results[3] = FLOOR_LEFT_OUTER_PORT & (FLOOR_LEFT_OUTER_MASK | FLOOR_RIGHT_OUTER_MASK);
    results[4] = WHEEL_DROP == WHEEL_DROP_ACTIVE;
    WHEEL_LEFT_FORWARD = !WHEEL_LEFT_FORWARD_ACTIVE;
    for (;;)
        ;
}

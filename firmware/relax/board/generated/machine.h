/* The robot behind the C cord. Made by cargo xtask codegen from robots/vileda-relax/robot.toml. Do not edit.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORD_MACHINE_H
#define CORD_MACHINE_H

#define CORD_SPEED_MOST_UM_PER_S 280000L
#define CORD_TURN_MOST_URAD_PER_S 1500000L
#define CORD_HALF_TRACK_UM 105000L
#define CORD_COUNT_UM 5000L
#define CORD_FULL_SPEED_UM_PER_S 380000L
#define CORD_DEVICE "relax"
#define CORD_FIRMWARE "0.1.0"
#define CORD_ROWS 6

/* Rows of `describe`. */
#define CORD_ROW_0 "{\"c\":\"describe\",\"row\":0,\"rows\":6,\"of\":\"limits\",\"speed-max\":0.28,\"turn-max\":1.5,\"track\":0.21,\"count\":0.005,\"radius\":0.155,\"swath\":0.24}"
#define CORD_ROW_1 "{\"c\":\"describe\",\"row\":1,\"rows\":6,\"of\":\"parts\",\"bumpers\":2,\"cliffs\":3,\"wheel-drops\":1,\"proximity\":1,\"dock-receivers\":0,\"buttons\":0,\"leds\":0,\"has\":\"encoders brush-main brush-sides vacuum\"}"
#define CORD_ROW_2 "{\"c\":\"describe\",\"row\":2,\"rows\":6,\"of\":\"commands\",\"commands\":\"hello hand describe info state drive motor stop arm clear set ping seen\"}"
#define CORD_ROW_3 "{\"c\":\"describe\",\"row\":3,\"rows\":6,\"of\":\"parameter\",\"name\":\"state-ms\",\"min\":10,\"max\":10000}"
#define CORD_ROW_4 "{\"c\":\"describe\",\"row\":4,\"rows\":6,\"of\":\"parameter\",\"name\":\"info-ms\",\"min\":100,\"max\":60000}"
#define CORD_ROW_5 "{\"c\":\"describe\",\"row\":5,\"rows\":6,\"of\":\"motors\",\"unguarded\":\"\",\"unmeasured\":\"\"}"

#endif

/* Where the C cord's variables live: those that are used most often in the memory that one instruction reaches, everything else in
 * the memory behind a pointer.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef PORT_H
#define PORT_H

#define CORD_NEAR __data

/* The longest command that fits into memory; the protocol has none that is longer. */
#define CORD_PACKET_MOST 128

#endif

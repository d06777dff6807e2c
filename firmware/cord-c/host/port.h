/* Nothing is near or far on this machine.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef PORT_H
#define PORT_H

#define CORD_NEAR

#endif

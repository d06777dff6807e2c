/* Tables that both languages share.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "crc.h"
#include "wire.h"

#include "tables.h"

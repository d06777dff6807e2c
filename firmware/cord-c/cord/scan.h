/* JSON straight from the packet, member by member: no tree, no tokens, no recursion, no copy. SPEC.md, section 3.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef CORD_SCAN_H
#define CORD_SCAN_H

#include "port.h"
#include <stdint.h>

enum cord_kind {
    CORD_KIND_ABSENT,
    CORD_KIND_TEXT,   /* between the quotes, escapes as they are */
    CORD_KIND_NUMBER, /* its spelling */
    CORD_KIND_TRUE,
    CORD_KIND_FALSE,
    CORD_KIND_NULL,
    CORD_KIND_COMPOSITE /* an array or an object: skipped */
};

/* A piece of the packet. */
struct cord_piece {
    uint8_t kind;
    uint8_t at;
    uint8_t length;
};

enum cord_scanned { CORD_SCAN_MEMBER, CORD_SCAN_END, CORD_SCAN_BROKEN };

/* Key and value of the member that was read last. */
extern CORD_NEAR struct cord_piece cord_key;
extern CORD_NEAR struct cord_piece cord_value;

/* Begins to read the packet, which must be UTF-8 and one object; false if it is not. */
uint8_t cord_scan_begin(void);
/* Reads the next member. */
uint8_t cord_scan_next(void);

/* The number at a piece in counts of a span, rounded half away from zero, as two's complement. */
extern CORD_NEAR uint32_t cord_number;
/* Reads it; false if it is out of the span. */
uint8_t cord_number_read(uint8_t at, uint8_t span);

/* The place of the name at a piece in `names`, each with its length before it and 0 at the end; 255 if it is none. */
uint8_t cord_name_find(const uint8_t *names, uint8_t at, uint8_t length);

#endif

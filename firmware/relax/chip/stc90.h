/* Registers of the STC90C58RD+ beyond those of an 8052: SDCC's own header for this family does not compile.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef STC90_H
#define STC90_H

#include <8052.h>

/* EXTRAM (bit 1) 0 = memory on the chip; ALEOFF (bit 0) 1 = no pulses on ALE. */
__sfr __at(0x8E) AUXR;
/* EN_WDT (bit 5), CLR_WDT (bit 4), prescaler in bits 0 to 2. */
__sfr __at(0xE1) WDT_CONTR;

#define AUXR_ALEOFF 0x01
#define WDT_RUN 0x30
/* 105 ms at 30 MHz with six clocks a cycle. */
#define WDT_105_MS 3
/* PCON: bit 7 of SCON shows a framing error. */
#define PCON_SMOD0 0x40
#define SCON_FE 0x80
/* Mode 1, receiver on. */
#define SCON_MODE_1 0x50
/* Timer 2 makes both rates of the UART. */
#define T2CON_BAUD 0x34
/* 38,265 of 38,400 bits/s at 30 MHz with six clocks a cycle. */
#define RCAP2_38400 0xFFCF

#endif

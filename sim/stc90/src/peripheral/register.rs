//! Addresses of the special function registers outside of the core, and bits of them that more than one file needs.

pub(crate) const P0: u8 = 0x80;
pub(crate) const PCON: u8 = 0x87;
pub(crate) const TCON: u8 = 0x88;
pub(crate) const TMOD: u8 = 0x89;
pub(crate) const TL0: u8 = 0x8A;
pub(crate) const TL1: u8 = 0x8B;
pub(crate) const TH0: u8 = 0x8C;
pub(crate) const TH1: u8 = 0x8D;
pub(crate) const AUXR: u8 = 0x8E;
pub(crate) const P1: u8 = 0x90;
pub(crate) const SCON: u8 = 0x98;
pub(crate) const SBUF: u8 = 0x99;
pub(crate) const P2: u8 = 0xA0;
pub(crate) const IE: u8 = 0xA8;
pub(crate) const SADDR: u8 = 0xA9;
pub(crate) const P3: u8 = 0xB0;
pub(crate) const IPH: u8 = 0xB7;
pub(crate) const IP: u8 = 0xB8;
pub(crate) const SADEN: u8 = 0xB9;
pub(crate) const XICON: u8 = 0xC0;
pub(crate) const T2CON: u8 = 0xC8;
pub(crate) const T2MOD: u8 = 0xC9;
pub(crate) const RCAP2L: u8 = 0xCA;
pub(crate) const RCAP2H: u8 = 0xCB;
pub(crate) const TL2: u8 = 0xCC;
pub(crate) const TH2: u8 = 0xCD;
/// Not 0xC1, where later families of the maker have it and the header that comes with SDCC says it is: a library that
/// was tried on this part and the maker's header of the STC89 agree on 0xE1.
pub(crate) const WDT_CONTR: u8 = 0xE1;
pub(crate) const ISP_DATA: u8 = 0xE2;
pub(crate) const ISP_ADDRH: u8 = 0xE3;
pub(crate) const ISP_ADDRL: u8 = 0xE4;
pub(crate) const ISP_CMD: u8 = 0xE5;
pub(crate) const ISP_TRIG: u8 = 0xE6;
pub(crate) const ISP_CONTR: u8 = 0xE7;
pub(crate) const P4: u8 = 0xE8;

/// PCON: doubles the rate of Timer 1 for the UART.
pub(super) const SMOD: u8 = 0x80;
/// PCON: SCON.7 is the framing error.
pub(super) const SMOD0: u8 = 0x40;

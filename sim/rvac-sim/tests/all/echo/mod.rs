//! The least firmware image that does something: an echo.

/// Copies the line from the host (RC13) to the line to the host (RB7), for ever.
const ECHO: [u32; 16] = [
    0x3C08_BF80, // lui   t0, AD1PCFG
    0x3508_9060, // ori   t0, t0, AD1PCFG
    0x3409_FFFF, // ori   t1, zero, all digital
    0xAD09_0000, // sw    t1, 0(t0)
    0x3C08_BF88, // lui   t0, ports
    0x3508_6000, // ori   t0, t0, ports
    0x3409_0080, // ori   t1, zero, bit 7
    0xAD09_0060, // sw    t1, LATB(t0): at rest
    0xAD09_0044, // sw    t1, TRISBCLR(t0): an output
    0x8D09_0090, // lw    t1, PORTC(t0)
    0x0000_0000, // nop
    0x0009_4982, // srl   t1, t1, 6
    0x3129_0080, // andi  t1, t1, bit 7
    0xAD09_0060, // sw    t1, LATB(t0)
    0x1000_FFFA, // b     to the lw
    0x0000_0000, // nop
];
/// DEVCFG2 to DEVCFG0 for 80 MHz from the crystal.
const CONFIGURATION: [u32; 3] = [0xFFF8_FFD9, 0xFF67_CEDB, 0x7FFF_FFFF];

/// The program as Intel HEX.
pub(crate) fn image() -> String {
    hex(&[(0, &ECHO), (0x2FF4, &CONFIGURATION)])
}

/// Words at addresses in boot flash.
fn hex(parts: &[(u16, &[u32])]) -> String {
    let record = |kind: u8, address: u16, data: &[u8]| {
        let mut bytes = vec![data.len() as u8, (address >> 8) as u8, address as u8, kind];
        bytes.extend(data);
        let sum = bytes.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
        bytes.push(sum.wrapping_neg());
        let digits: String = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
        format!(":{digits}\n")
    };
    let mut text = record(4, 0, &[0x1F, 0xC0]);
    for (start, words) in parts {
        for (index, word) in words.iter().enumerate() {
            text += &record(0, start + 4 * index as u16, &word.to_le_bytes());
        }
    }
    text + &record(1, 0, &[])
}

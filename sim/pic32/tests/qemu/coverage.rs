//! The random programs hold every instruction of user mode.

use crate::block::Kind;
use crate::program::Program;

/// Name, mask and value of each.
#[rustfmt::skip]
const INSTRUCTIONS: [(&str, u32, u32); 103] = [
    ("add", 0xFC00_003F, 0x20), ("addi", 0xFC00_0000, 0x2000_0000), ("addiu", 0xFC00_0000, 0x2400_0000),
    ("addu", 0xFC00_003F, 0x21), ("and", 0xFC00_003F, 0x24), ("andi", 0xFC00_0000, 0x3000_0000),
    ("beq", 0xFC00_0000, 0x1000_0000), ("beql", 0xFC00_0000, 0x5000_0000), ("bgez", 0xFC1F_0000, 0x0401_0000),
    ("bgezal", 0xFC1F_0000, 0x0411_0000), ("bgezall", 0xFC1F_0000, 0x0413_0000), ("bgezl", 0xFC1F_0000, 0x0403_0000),
    ("bgtz", 0xFC00_0000, 0x1C00_0000), ("bgtzl", 0xFC00_0000, 0x5C00_0000), ("blez", 0xFC00_0000, 0x1800_0000),
    ("blezl", 0xFC00_0000, 0x5800_0000), ("bltz", 0xFC1F_0000, 0x0400_0000), ("bltzal", 0xFC1F_0000, 0x0410_0000),
    ("bltzall", 0xFC1F_0000, 0x0412_0000), ("bltzl", 0xFC1F_0000, 0x0402_0000), ("bne", 0xFC00_0000, 0x1400_0000),
    ("bnel", 0xFC00_0000, 0x5400_0000), ("clo", 0xFC00_003F, 0x7000_0021), ("clz", 0xFC00_003F, 0x7000_0020),
    ("div", 0xFC00_003F, 0x1A), ("divu", 0xFC00_003F, 0x1B), ("ehb", u32::MAX, 0xC0),
    ("ext", 0xFC00_003F, 0x7C00_0000), ("ins", 0xFC00_003F, 0x7C00_0004), ("j", 0xFC00_0000, 0x0800_0000),
    ("jal", 0xFC00_0000, 0x0C00_0000), ("jalr", 0xFC00_07FF, 0x09), ("jalr.hb", 0xFC00_07FF, 0x409),
    ("jr", 0xFC00_07FF, 0x08), ("jr.hb", 0xFC00_07FF, 0x408), ("lb", 0xFC00_0000, 0x8000_0000),
    ("lbu", 0xFC00_0000, 0x9000_0000), ("lh", 0xFC00_0000, 0x8400_0000), ("lhu", 0xFC00_0000, 0x9400_0000),
    ("ll", 0xFC00_0000, 0xC000_0000), ("lui", 0xFFE0_0000, 0x3C00_0000), ("lw", 0xFC00_0000, 0x8C00_0000),
    ("lwl", 0xFC00_0000, 0x8800_0000), ("lwr", 0xFC00_0000, 0x9800_0000), ("madd", 0xFC00_003F, 0x7000_0000),
    ("maddu", 0xFC00_003F, 0x7000_0001), ("mfhi", 0xFC00_003F, 0x10), ("mflo", 0xFC00_003F, 0x12),
    ("movn", 0xFC00_003F, 0x0B), ("movz", 0xFC00_003F, 0x0A), ("msub", 0xFC00_003F, 0x7000_0004),
    ("msubu", 0xFC00_003F, 0x7000_0005), ("mthi", 0xFC00_003F, 0x11), ("mtlo", 0xFC00_003F, 0x13),
    ("mul", 0xFC00_003F, 0x7000_0002), ("mult", 0xFC00_003F, 0x18), ("multu", 0xFC00_003F, 0x19),
    ("nop", u32::MAX, 0), ("nor", 0xFC00_003F, 0x27), ("or", 0xFC00_003F, 0x25), ("ori", 0xFC00_0000, 0x3400_0000),
    ("pause", u32::MAX, 0x140), ("pref", 0xFC00_0000, 0xCC00_0000), ("rotr", 0xFFE0_003F, 0x0020_0002),
    ("rotrv", 0xFC00_007F, 0x46), ("sb", 0xFC00_0000, 0xA000_0000), ("sc", 0xFC00_0000, 0xE000_0000),
    ("seb", 0xFFE0_07FF, 0x7C00_0420), ("seh", 0xFFE0_07FF, 0x7C00_0620), ("sh", 0xFC00_0000, 0xA400_0000),
    ("sll", 0xFFE0_003F, 0x00), ("sllv", 0xFC00_003F, 0x04), ("slt", 0xFC00_003F, 0x2A),
    ("slti", 0xFC00_0000, 0x2800_0000), ("sltiu", 0xFC00_0000, 0x2C00_0000), ("sltu", 0xFC00_003F, 0x2B),
    ("sra", 0xFFE0_003F, 0x03), ("srav", 0xFC00_003F, 0x07), ("srl", 0xFFE0_003F, 0x02),
    ("srlv", 0xFC00_007F, 0x06), ("ssnop", u32::MAX, 0x40), ("sub", 0xFC00_003F, 0x22), ("subu", 0xFC00_003F, 0x23),
    ("sw", 0xFC00_0000, 0xAC00_0000), ("swl", 0xFC00_0000, 0xA800_0000), ("swr", 0xFC00_0000, 0xB800_0000),
    ("sync", u32::MAX, 0x0F), ("synci", 0xFC1F_0000, 0x041F_0000), ("teqi", 0xFC1F_0000, 0x040C_0000),
    ("teq", 0xFC00_003F, 0x34), ("tge", 0xFC00_003F, 0x30), ("tgeu", 0xFC00_003F, 0x31),
    ("tltiu", 0xFC1F_0000, 0x040B_0000), ("tlti", 0xFC1F_0000, 0x040A_0000), ("tnei", 0xFC1F_0000, 0x040E_0000),
    ("tgei", 0xFC1F_0000, 0x0408_0000), ("tgeiu", 0xFC1F_0000, 0x0409_0000), ("tlt", 0xFC00_003F, 0x32),
    ("tltu", 0xFC00_003F, 0x33), ("tne", 0xFC00_003F, 0x36), ("wsbh", 0xFFE0_07FF, 0x7C00_00A0),
    ("xor", 0xFC00_003F, 0x26), ("xori", 0xFC00_0000, 0x3800_0000),
];

#[test]
fn programs_hold_every_instruction_of_user_mode() {
    let program = Program::random(0, 1000, Kind::Process);
    let words = &program.words[program.blocks[0]..];
    let missing: Vec<&str> = INSTRUCTIONS
        .iter()
        .filter(|(_, mask, value)| words.iter().filter(|word| **word & mask == *value).count() < 10)
        .map(|(name, ..)| *name)
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}

//! Columns 6 to 15 of the instruction map: a byte of internal RAM that R0 or R1 points to, or R0 to R7 themselves.

use super::{Bus, Cpu};

/// Columns from here on name a register; those before it a register that holds an address.
const REGISTER_COLUMNS: u8 = 8;

impl Cpu {
    /// Executes the instruction of this row and column.
    #[inline]
    pub(super) fn regular<B: Bus>(&mut self, row: u8, column: u8, bus: &mut B) {
        let place = usize::from(if column < REGISTER_COLUMNS {
            self.indirect_place(column)
        } else {
            self.register_place(column)
        });
        match row {
            0x0 => self.ram[place] = self.ram[place].wrapping_add(1),
            0x1 => self.ram[place] = self.ram[place].wrapping_sub(1),
            0x7 => self.ram[place] = self.fetch(),
            0x8 => {
                let target = self.fetch();
                self.write(target, self.ram[place], bus);
            }
            0xA => {
                let source = self.fetch();
                self.ram[place] = self.read(source, bus);
            }
            0xB => {
                let constant = self.fetch();
                self.jump_if_unequal(self.ram[place], constant);
            }
            0xC => std::mem::swap(&mut self.a, &mut self.ram[place]),
            0xD if column < REGISTER_COLUMNS => self.exchange_digit(place),
            0xD => {
                self.ram[place] = self.ram[place].wrapping_sub(1);
                self.jump_if(self.ram[place] != 0);
            }
            0xF => self.ram[place] = self.a,
            _ => self.accumulate(row, self.ram[place]),
        }
    }

    /// XCHD: exchanges the lower halves.
    fn exchange_digit(&mut self, place: usize) {
        let byte = self.ram[place];
        self.ram[place] = byte & 0xF0 | self.a & 0x0F;
        self.a = self.a & 0xF0 | byte & 0x0F;
    }
}

// Runs a firmware of an RP2040 in the emulator rp2040js, says a packet to its UART0, and prints each packet that it says, one a line.
//
//   node run.mjs FILE.elf MILLISECONDS PACKET
import { readFileSync } from 'node:fs';
import { Simulator } from 'rp2040js';

const [file, milliseconds, packet] = process.argv.slice(2);
const FLASH = 0x10000000;
const FLASH_END = 0x11000000;
// Behind the first 256 bytes, which set up the flash and which an emulator needs not.
const VECTORS = FLASH + 0x100;
const SEPARATOR = 0x1f;
// The register in which a UART keeps errors of reception: the emulator has none, and reads all ones.
const RECEIVE_STATUS = 0x4;
const NANOSECONDS_A_CYCLE = 8;

const simulator = new Simulator();
const chip = simulator.rp2040;
chip.logger = { debug() {}, info() {}, warn() {}, error: (part, text) => console.error(part, text) };

// The loadable parts of the ELF file (program headers of type 1) that lie in the flash.
const elf = readFileSync(file);
const [table, size, count] = [elf.readUInt32LE(28), elf.readUInt16LE(42), elf.readUInt16LE(44)];
for (let part = 0; part < count; part += 1) {
    const head = table + part * size;
    const [offset, place, bytes] = [elf.readUInt32LE(head + 4), elf.readUInt32LE(head + 12), elf.readUInt32LE(head + 16)];
    if (elf.readUInt32LE(head) === 1 && place >= FLASH && place < FLASH_END) {
        chip.flash.set(elf.subarray(offset, offset + bytes), place - FLASH);
    }
}

const word = (address) => chip.readUint32(address) >>> 0;
chip.core.SP = word(VECTORS);
chip.core.VTOR = VECTORS;
chip.core.PC = word(VECTORS + 4) & ~1;

const uart = chip.uart[0];
const read = uart.readUint32.bind(uart);
uart.readUint32 = (offset) => (offset === RECEIVE_STATUS ? 0 : read(offset));
let said = [];
uart.onByte = (byte) => {
    if (byte === SEPARATOR) {
        if (said.length > 0) {
            console.log(Buffer.from(said).toString('latin1'));
        }
        said = [];
    } else {
        said.push(byte);
    }
};

const end = Number(milliseconds) * 1e6;
let is_asked = false;
while (simulator.clock.nanos < end) {
    if (!is_asked && simulator.clock.nanos > end / 2) {
        is_asked = true;
        for (const letter of packet) {
            uart.feedByte(letter.charCodeAt(0));
        }
        uart.feedByte(SEPARATOR);
    }
    if (chip.core.waiting) {
        simulator.clock.tick(Math.max(simulator.clock.nanosToNextAlarm, NANOSECONDS_A_CYCLE));
    } else {
        simulator.clock.tick(chip.core.executeInstruction() * NANOSECONDS_A_CYCLE);
    }
}

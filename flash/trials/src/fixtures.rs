//! Chips and images that trials share.

use pic32::image::Image;
use pic32::machine::Machine;
use pic32_icsp::FlashImage;

/// DEVCFG3 to DEVCFG0: the internal 8 MHz, nothing protected.
const CONFIGURATION: [u32; 4] = [0xFFFF_1234, 0xFFF8_FFD9, 0xFF74_CED8, 0x7FFF_FFFF];

/// Bytes that look like noise, from a seed.
pub fn noise(length: usize, seed: u64) -> Vec<u8> {
    let mut random = home::Pcg::new(seed, 0xF1A5);
    (0..length).map(|_| (random.next_u32() >> 24) as u8).collect()
}

/// An image with so many bytes of program flash from its start, and so many of boot flash.
///
/// # Panics
/// When they do not fit.
pub fn flash_image(program_bytes: usize, boot_bytes: usize, seed: u64) -> FlashImage {
    let mut image = FlashImage::erased();
    let configuration: Vec<u8> = CONFIGURATION.into_iter().flat_map(u32::to_le_bytes).collect();
    let pieces = [
        (0x1D00_0000, noise(program_bytes, seed)),
        (0x1FC0_0000, noise(boot_bytes, seed + 1)),
        (0x1FC0_2FF0, configuration),
    ];
    for (address, bytes) in pieces {
        assert!(image.write(address, &bytes), "it fits");
    }
    image
}

/// The image as an Intel HEX file.
pub fn hex_of(image: &FlashImage) -> String {
    let mut text = String::new();
    for (start, bytes) in [(0x1D00_0000_u32, image.program()), (0x1FC0_0000, image.boot())] {
        let mut upper = None;
        for (index, row) in bytes.chunks(16).enumerate() {
            if row.iter().all(|byte| *byte == 0xFF) {
                continue;
            }
            let address = start + 16 * index as u32;
            if upper != Some(address >> 16) {
                upper = Some(address >> 16);
                text += &record(0, 4, &((address >> 16) as u16).to_be_bytes());
            }
            text += &record(address as u16, 0, row);
        }
    }
    text + &record(0, 1, &[])
}

fn record(address: u16, kind: u8, data: &[u8]) -> String {
    let [high, low] = address.to_be_bytes();
    let mut bytes = vec![data.len() as u8, high, low, kind];
    bytes.extend_from_slice(data);
    let sum = bytes.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
    bytes.push(sum.wrapping_neg());
    let digits: String = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    format!(":{digits}\n")
}

/// A chip that holds this image.
///
/// # Panics
/// Never: the sizes are those of the part.
pub fn chip_with(image: &FlashImage) -> Machine {
    let mut content = Image::erased();
    let pieces = [(0x1D00_0000, image.program()), (0x1FC0_0000, image.boot())];
    for (address, bytes) in pieces {
        content.write(address, bytes).expect("sizes of the part");
    }
    Machine::new(&content)
}

/// What a chip holds.
///
/// # Panics
/// Never: the sizes are those of the part.
pub fn content_of(machine: &Machine) -> FlashImage {
    let (mut program, mut boot) = (vec![0; 0x4_0000], vec![0; 0x3000]);
    machine.memory().read(0x1D00_0000, &mut program).expect("flash");
    machine.memory().read(0x1FC0_0000, &mut boot).expect("flash");
    FlashImage::of(&program, &boot).expect("sizes of the part")
}

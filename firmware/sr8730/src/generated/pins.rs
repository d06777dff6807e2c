//! Pins of the board. Made by cargo xtask codegen from robots/samsung-sr8730/pinout.toml. Do not edit.

/// A port of the chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Port {
    /// Port A.
    A,
    /// Port B, whose pins are analog after reset.
    B,
    /// Port C.
    C,
    /// Port D.
    D,
    /// Port E.
    E,
    /// Port F.
    F,
    /// Port G.
    G,
}

/// What a pin is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Digital input.
    Input,
    /// Digital output.
    Output,
    /// Analog input.
    Analog,
    /// Output of an output compare module.
    Pwm,
    /// Input of an input capture module.
    Capture,
    /// Not used: kept an input.
    Spare,
}

/// The level that means what a signal's name says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Active {
    /// 3.3 V.
    High,
    /// 0 V.
    Low,
    /// Nobody knows.
    Unknown,
}

/// One pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signal {
    /// Its port.
    pub port: Port,
    /// Its bit in the port's registers, 0..=15.
    pub bit: u8,
    /// What it is used for.
    pub kind: Kind,
    /// The level that means what its name says.
    pub active: Active,
    /// Its number as a change notice, if it has one.
    pub change: Option<u8>,
    /// Its number as an analog input, if it has one.
    pub analog: Option<u8>,
}

impl Port {
    /// 0 for port A to 6 for port G: the register blocks lie in this order.
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }
}

impl Signal {
    const fn new(port: Port, bit: u8, kind: Kind, active: Active) -> Self {
        Self {
            port,
            bit,
            kind,
            active,
            change: None,
            analog: None,
        }
    }

    const fn with_change(self, number: u8) -> Self {
        Self {
            change: Some(number),
            ..self
        }
    }

    const fn with_analog(self, number: u8) -> Self {
        Self {
            analog: Some(number),
            ..self
        }
    }

    /// Its bit in the port's registers as a mask.
    #[must_use]
    pub const fn mask(self) -> u32 {
        1 << self.bit
    }

    /// Whether it is active in a word that was read from its port; never, when nobody knows the active level.
    #[must_use]
    pub const fn is_active(self, word: u32) -> bool {
        match self.active {
            Active::High => word & self.mask() != 0,
            Active::Low => word & self.mask() == 0,
            Active::Unknown => false,
        }
    }
}

/// What start-up writes to one port: first `lat`, then `tris`, so that no output glitches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PortStart {
    /// The port.
    pub port: Port,
    /// Safe levels of its outputs.
    pub lat: u32,
    /// 1 = input, 0 = output.
    pub tris: u32,
}

const fn start(port: Port, lat: u32, tris: u32) -> PortStart {
    PortStart { port, lat, tris }
}

/// RG9, package pin 14, CN11: bumper, left half.
pub const BUMPER_LEFT: Signal = Signal::new(Port::G, 9, Kind::Input, Active::Low).with_change(11);
/// RG15, package pin 1: bumper, right half; its pull-up is assumed to be like the left one's; no change notice on this pin, so it is polled.
pub const BUMPER_RIGHT: Signal = Signal::new(Port::G, 15, Kind::Input, Active::Low);
/// RD6, package pin 83, CN15: low = the left wheel hangs.
pub const WHEEL_DROP_LEFT: Signal = Signal::new(Port::D, 6, Kind::Input, Active::Low).with_change(15);
/// RD7, package pin 84, CN16: low = the right wheel hangs.
pub const WHEEL_DROP_RIGHT: Signal = Signal::new(Port::D, 7, Kind::Input, Active::Low).with_change(16);
/// RF0, package pin 87: low = the box is in.
pub const DUST_BOX: Signal = Signal::new(Port::F, 0, Kind::Input, Active::Low);
/// RE9, package pin 19, INT2: low while any of the three buttons is pressed.
pub const BUTTON_ANY: Signal = Signal::new(Port::E, 9, Kind::Input, Active::Low);
/// RB0, package pin 25, AN0: resistor ladder of the three buttons; its levels are calibration values; must stay analog.
pub const BUTTON_LADDER: Signal = Signal::new(Port::B, 0, Kind::Analog, Active::High)
    .with_change(2)
    .with_analog(0);
/// RD0, package pin 72, OC1: A3950 ENABLE.
pub const WHEEL_LEFT_ENABLE: Signal = Signal::new(Port::D, 0, Kind::Pwm, Active::High);
/// RE7, package pin 5: A3950 MODE: high = brake in the off-time (slow decay), low = coast.
pub const WHEEL_LEFT_MODE: Signal = Signal::new(Port::E, 7, Kind::Output, Active::High);
/// RC1, package pin 6: A3950 PHASE: low = forward.
pub const WHEEL_LEFT_PHASE: Signal = Signal::new(Port::C, 1, Kind::Output, Active::Low);
/// RD3, package pin 78, OC4: A3950 ENABLE.
pub const WHEEL_RIGHT_ENABLE: Signal = Signal::new(Port::D, 3, Kind::Pwm, Active::High);
/// RG6, package pin 10: A3950 MODE: high = brake in the off-time (slow decay), low = coast.
pub const WHEEL_RIGHT_MODE: Signal = Signal::new(Port::G, 6, Kind::Output, Active::High).with_change(8);
/// RG7, package pin 11: A3950 PHASE: high = forward.
pub const WHEEL_RIGHT_PHASE: Signal = Signal::new(Port::G, 7, Kind::Output, Active::High).with_change(9);
/// RD8, package pin 68, IC1: quadrature or pulse pair; way per count and order of the lines are calibration values.
pub const WHEEL_LEFT_ENCODER_1: Signal = Signal::new(Port::D, 8, Kind::Capture, Active::Unknown);
/// RD9, package pin 69, IC2: as line 1.
pub const WHEEL_LEFT_ENCODER_2: Signal = Signal::new(Port::D, 9, Kind::Capture, Active::Unknown);
/// RD11, package pin 71, IC4: as the left wheel; lines 1 and 2 are IC4 and IC3, not the other way round.
pub const WHEEL_RIGHT_ENCODER_1: Signal = Signal::new(Port::D, 11, Kind::Capture, Active::Unknown);
/// RD10, package pin 70, IC3: as line 1.
pub const WHEEL_RIGHT_ENCODER_2: Signal = Signal::new(Port::D, 10, Kind::Capture, Active::Unknown);
/// RB14, package pin 43, AN14: from the left A3950; scale and zero are calibration values.
pub const WHEEL_LEFT_CURRENT: Signal =
    Signal::new(Port::B, 14, Kind::Analog, Active::Unknown).with_analog(14);
/// RB13, package pin 42, AN13: from the right A3950; scale and zero are calibration values.
pub const WHEEL_RIGHT_CURRENT: Signal = Signal::new(Port::B, 13, Kind::Analog, Active::High).with_analog(13);
/// RD1, package pin 76, OC2: DRV8840 ENABLE.
pub const BRUSH_MAIN_ENABLE: Signal = Signal::new(Port::D, 1, Kind::Pwm, Active::High);
/// RC2, package pin 7: DRV8840 PHASE: low = forward.
pub const BRUSH_MAIN_PHASE: Signal = Signal::new(Port::C, 2, Kind::Output, Active::Low);
/// RC3, package pin 8: DRV8840 DECAY: low = slow decay (brake), high = fast decay.
pub const BRUSH_MAIN_DECAY: Signal = Signal::new(Port::C, 3, Kind::Output, Active::Low);
/// RB5, package pin 20, CN7: pulses of the turning main brush; shares its pin with AN5, so AD1PCFG must make it digital.
pub const BRUSH_MAIN_ENCODER: Signal = Signal::new(Port::B, 5, Kind::Input, Active::Low)
    .with_change(7)
    .with_analog(5);
/// RA4, package pin 60: both side brushes, on or off; the pin is JTAG TDI until JTAG is switched off.
pub const BRUSH_SIDES: Signal = Signal::new(Port::A, 4, Kind::Output, Active::High);
/// RD5, package pin 82: suction motor, on or off.
pub const VACUUM: Signal = Signal::new(Port::D, 5, Kind::Output, Active::High).with_change(14);
/// RB11, package pin 35, AN11: that the line is analog is assumed; what lights its emitter is a calibration value.
pub const CLIFF_LEFT: Signal = Signal::new(Port::B, 11, Kind::Analog, Active::High).with_analog(11);
/// RB10, package pin 34, AN10: as the left one.
pub const CLIFF_MIDDLE: Signal = Signal::new(Port::B, 10, Kind::Analog, Active::High).with_analog(10);
/// RB8, package pin 32, AN8: as the left one.
pub const CLIFF_RIGHT: Signal = Signal::new(Port::B, 8, Kind::Analog, Active::High).with_analog(8);
/// RD15, package pin 48: select line of both sensor multiplexers, bit 0.
pub const PROXIMITY_SELECT_A: Signal = Signal::new(Port::D, 15, Kind::Output, Active::High).with_change(21);
/// RD14, package pin 47: select line, bit 1.
pub const PROXIMITY_SELECT_B: Signal = Signal::new(Port::D, 14, Kind::Output, Active::High).with_change(20);
/// RB15, package pin 44: select line, bit 2; shares its pin with AN15, so AD1PCFG must make it digital.
pub const PROXIMITY_SELECT_C: Signal = Signal::new(Port::B, 15, Kind::Output, Active::High)
    .with_change(12)
    .with_analog(15);
/// RB12, package pin 41, AN12: common of the receive multiplexer; the original drove it as an output by mistake.
pub const PROXIMITY_RECEIVE: Signal = Signal::new(Port::B, 12, Kind::Analog, Active::High).with_analog(12);
/// RD12, package pin 79: common of the transmit multiplexer: infrared emitter, and the 38 kHz signal to the dock on channel 3.
pub const PROXIMITY_EMIT: Signal = Signal::new(Port::D, 12, Kind::Output, Active::High);
/// RA14, package pin 66, INT3: dock beams, front left; low while it hears a carrier.
pub const DOCK_RECEIVER_LEFT: Signal = Signal::new(Port::A, 14, Kind::Input, Active::Low);
/// RA15, package pin 67, INT4: dock beams, front right.
pub const DOCK_RECEIVER_RIGHT: Signal = Signal::new(Port::A, 15, Kind::Input, Active::Low);
/// RF6, package pin 55, INT0: 38 kHz receiver module.
pub const REAR_RECEIVER_LEFT: Signal = Signal::new(Port::F, 6, Kind::Input, Active::Low);
/// RE8, package pin 18, INT1: 38 kHz receiver module.
pub const REAR_RECEIVER_RIGHT: Signal = Signal::new(Port::E, 8, Kind::Input, Active::Low);
/// RA10, package pin 29: probably not fitted.
pub const MIDDLE_RECEIVER_LEFT: Signal = Signal::new(Port::A, 10, Kind::Input, Active::Unknown);
/// RG8, package pin 12, CN10: not connected on the SR8730.
pub const MIDDLE_RECEIVER_RIGHT: Signal =
    Signal::new(Port::G, 8, Kind::Input, Active::Unknown).with_change(10);
/// RB3, package pin 22, AN3: behind the shunt: the battery; the original's name is misleading.
pub const BATTERY_VOLTAGE: Signal = Signal::new(Port::B, 3, Kind::Analog, Active::High)
    .with_change(5)
    .with_analog(3);
/// RB2, package pin 23, AN2: before the shunt: the charger's side.
pub const CHARGER_VOLTAGE: Signal = Signal::new(Port::B, 2, Kind::Analog, Active::High)
    .with_change(4)
    .with_analog(2);
/// RB4, package pin 21, AN4: 10 k NTC in the pack, 1.5 k to 3.3 V, 10 k to ground; hotter = lower.
pub const BATTERY_THERMISTOR: Signal = Signal::new(Port::B, 4, Kind::Analog, Active::Low)
    .with_change(6)
    .with_analog(4);
/// RB1, package pin 24, CN3: high = dock contacts or adapter powered; shares its pin with AN1, so AD1PCFG must make it digital.
pub const ADAPTER: Signal = Signal::new(Port::B, 1, Kind::Input, Active::High)
    .with_change(3)
    .with_analog(1);
/// RD2, package pin 77, OC3: drives the NPN of the charging switch; high = charge by the schematic, stated nowhere.
pub const CHARGE_ENABLE: Signal = Signal::new(Port::D, 2, Kind::Pwm, Active::High);
/// RA6, package pin 91: group 1: done, auto, spot, repeat, home on lines 0 to 4.
pub const LIGHT_SUPPLY_MAIN: Signal = Signal::new(Port::A, 6, Kind::Output, Active::High);
/// RG1, package pin 89: group 2: battery bars on lines 2 to 4.
pub const LIGHT_SUPPLY_BATTERY: Signal = Signal::new(Port::G, 1, Kind::Output, Active::High);
/// RG0, package pin 90: a third group supply; what it feeds is not known.
pub const LIGHT_SUPPLY_UNKNOWN: Signal = Signal::new(Port::G, 0, Kind::Output, Active::High);
/// RE2, package pin 98.
pub const LIGHT_LINE_0: Signal = Signal::new(Port::E, 2, Kind::Output, Active::High);
/// RE3, package pin 99.
pub const LIGHT_LINE_1: Signal = Signal::new(Port::E, 3, Kind::Output, Active::High);
/// RE4, package pin 100.
pub const LIGHT_LINE_2: Signal = Signal::new(Port::E, 4, Kind::Output, Active::High);
/// RE5, package pin 3.
pub const LIGHT_LINE_3: Signal = Signal::new(Port::E, 5, Kind::Output, Active::High);
/// RE6, package pin 4.
pub const LIGHT_LINE_4: Signal = Signal::new(Port::E, 6, Kind::Output, Active::High);
/// RA7, package pin 92: common of digit 1.
pub const DISPLAY_DIGIT_1: Signal = Signal::new(Port::A, 7, Kind::Output, Active::High);
/// RG14, package pin 95: common of digit 2.
pub const DISPLAY_DIGIT_2: Signal = Signal::new(Port::G, 14, Kind::Output, Active::High);
/// RG13, package pin 97: common of digit 3.
pub const DISPLAY_DIGIT_3: Signal = Signal::new(Port::G, 13, Kind::Output, Active::High);
/// RG12, package pin 96: common of digit 4.
pub const DISPLAY_DIGIT_4: Signal = Signal::new(Port::G, 12, Kind::Output, Active::High);
/// RE0, package pin 93: top.
pub const DISPLAY_SEGMENT_A: Signal = Signal::new(Port::E, 0, Kind::Output, Active::High);
/// RE1, package pin 94: top right; the other five segments are presumably light lines 0 to 4.
pub const DISPLAY_SEGMENT_B: Signal = Signal::new(Port::E, 1, Kind::Output, Active::High);
/// RF1, package pin 88.
pub const DISPLAY_COLON: Signal = Signal::new(Port::F, 1, Kind::Output, Active::High);
/// RA1, package pin 38: select line of the 14051, bit 0; the pin is JTAG TCK until JTAG is switched off.
pub const SOUND_SELECT_A: Signal = Signal::new(Port::A, 1, Kind::Output, Active::High);
/// RF13, package pin 39: bit 1.
pub const SOUND_SELECT_B: Signal = Signal::new(Port::F, 13, Kind::Output, Active::High);
/// RC4, package pin 9: bit 2.
pub const SOUND_SELECT_C: Signal = Signal::new(Port::C, 4, Kind::Output, Active::High);
/// RD4, package pin 81, OC5: common of the 14051; channel 7 is the speaker.
pub const SOUND_TONE: Signal = Signal::new(Port::D, 4, Kind::Pwm, Active::High).with_change(13);
/// RD13, package pin 80: high while a tone sounds.
pub const SOUND_ENABLE: Signal = Signal::new(Port::D, 13, Kind::Output, Active::High).with_change(19);
/// RC13, package pin 73, CN1: from our Linux board; how it reaches the connector is stated nowhere.
pub const LINK_RECEIVE: Signal = Signal::new(Port::C, 13, Kind::Input, Active::High).with_change(1);
/// RB7, package pin 27, PGD2: to our Linux board; idle high; shares its pin with AN7, so AD1PCFG must make it digital.
pub const LINK_TRANSMIT: Signal = Signal::new(Port::B, 7, Kind::Output, Active::High).with_analog(7);
/// RB6, package pin 26, PGC2: where the link's input is if RC13 does not reach the connector; no change notice, no capture: only a timer can sample it; shares its pin with AN6.
pub const LINK_RECEIVE_SAMPLED: Signal = Signal::new(Port::B, 6, Kind::Input, Active::High).with_analog(6);
/// RF7, package pin 54: low = the gyro module has power.
pub const GYRO_POWER: Signal = Signal::new(Port::F, 7, Kind::Output, Active::Low);
/// RF2, package pin 52, U1RX: gyro module or built-in Linux board: not recorded which.
pub const UART1_RECEIVE: Signal = Signal::new(Port::F, 2, Kind::Input, Active::High);
/// RF3, package pin 51, U1TX: as uart1-receive; kept an input until somebody knows.
pub const UART1_TRANSMIT: Signal = Signal::new(Port::F, 3, Kind::Spare, Active::High);
/// RF4, package pin 49, U2RX: gyro module or built-in Linux board: not recorded which.
pub const UART2_RECEIVE: Signal = Signal::new(Port::F, 4, Kind::Input, Active::High).with_change(17);
/// RF5, package pin 50, U2TX: as uart2-receive; kept an input until somebody knows.
pub const UART2_TRANSMIT: Signal = Signal::new(Port::F, 5, Kind::Spare, Active::High).with_change(18);
/// RA9, package pin 28: to pin 10 of the built-in Linux board's connector.
pub const LINUX_BOARD_10: Signal = Signal::new(Port::A, 9, Kind::Spare, Active::Unknown);
/// RB9, package pin 33: to pin 11 of the built-in Linux board's connector; shares its pin with AN9.
pub const LINUX_BOARD_11: Signal = Signal::new(Port::B, 9, Kind::Spare, Active::High).with_analog(9);
/// RA0, package pin 17: JTAG TMS until JTAG is switched off.
pub const SPARE_RA0: Signal = Signal::new(Port::A, 0, Kind::Spare, Active::Unknown);
/// RA2, package pin 58.
pub const SPARE_RA2: Signal = Signal::new(Port::A, 2, Kind::Spare, Active::Unknown);
/// RA3, package pin 59.
pub const SPARE_RA3: Signal = Signal::new(Port::A, 3, Kind::Spare, Active::Unknown);
/// RA5, package pin 61: JTAG TDO until JTAG is switched off.
pub const SPARE_RA5: Signal = Signal::new(Port::A, 5, Kind::Spare, Active::Unknown);
/// RC14, package pin 74: stated as not connected (grounded).
pub const SPARE_RC14: Signal = Signal::new(Port::C, 14, Kind::Spare, Active::Unknown).with_change(0);
/// RF8, package pin 53.
pub const SPARE_RF8: Signal = Signal::new(Port::F, 8, Kind::Spare, Active::Unknown);
/// RF12, package pin 40.
pub const SPARE_RF12: Signal = Signal::new(Port::F, 12, Kind::Spare, Active::Unknown);
/// RG2, package pin 57.
pub const SPARE_RG2: Signal = Signal::new(Port::G, 2, Kind::Spare, Active::Unknown);
/// RG3, package pin 56.
pub const SPARE_RG3: Signal = Signal::new(Port::G, 3, Kind::Spare, Active::Unknown);
/// Start-up words of all ports.
pub const START: [PortStart; 7] = [
    start(Port::A, 0x0000, 0xFF2D),
    start(Port::B, 0x0080, 0x7F7F),
    start(Port::C, 0x0000, 0xFFE1),
    start(Port::D, 0x0000, 0x0FC0),
    start(Port::E, 0x0080, 0xFF00),
    start(Port::F, 0x0080, 0xDF7D),
    start(Port::G, 0x0040, 0x8F3C),
];

/// AD1PCFG: 1 = the pin with this analog number is digital.
pub const DIGITAL: u32 = 0x82E2;
/// Analog numbers of all signals that are analog, as a mask (AD1CSSL takes a subset).
pub const ANALOG: u32 = 0x7D1D;
/// CNPUE: weak pull-ups of change notices.
pub const PULL_UPS: u32 = 0x000002;

//! A board whose every part is one memory cell, so that nothing of cordlib can be optimised away and nothing of a real
//! peripheral library is counted. It is linked and measured, never run.
#![no_std]
#![no_main]

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicU32, Ordering};

use cordlib::board::{
    Absent, Beeper, Board, BumperSwitches, Buttons, ChargeDrive, Charger, ChargerReadings, CleaningMotor,
    CliffLevels, CliffSensors, Clock, CurrentSense, DockBeams, DockContacts, DockRequest, DustBox, Emitters,
    Encoders, HardwareChecks, HardwareFault, HeadingSensor, KeptMemory, KeptWords, Lights, Link, Parts,
    PinProbe, ProximitySensors, Received, ResetRecord, Watchdog, WheelCounts, WheelDrive, WheelDropSwitches,
    WheelMotors,
};
use cordlib::{Cord, Parameters};
use rvac_protocol::message::{
    Bumpers, ButtonProbe, Cliffs, Currents, DockReceivers, EncoderProbe, Gyro, Limits, PROBE_CHANNELS,
    PROBE_PORTS, PROXIMITY_SENSORS, Refusal, ResetCause, WheelDrops,
};
use rvac_units::{
    Angle, AngularSpeed, Current, Frequency, Length, Ratio, Speed, Temperature, Throttle, Tick,
};

static CELL: AtomicU32 = AtomicU32::new(0);

fn read() -> u32 {
    CELL.load(Ordering::Relaxed)
}

fn write(value: u32) {
    CELL.store(value, Ordering::Relaxed);
}

fn bit(number: u32) -> bool {
    read() & (1 << number) != 0
}

/// Every part.
#[derive(Clone, Copy, Debug)]
struct ProbeBoard;

impl Parts for ProbeBoard {
    type Clock = ProbeBoard;
    type Link = ProbeBoard;
    type Wheels = ProbeBoard;
    type Reset = ProbeBoard;
    type Watchdog = ProbeBoard;
    type Kept = ProbeBoard;
    type Checks = ProbeBoard;
    type Encoders = ProbeBoard;
    type Bumpers = ProbeBoard;
    type Cliffs = ProbeBoard;
    type WheelDrops = ProbeBoard;
    type Proximity = ProbeBoard;
    type Gyro = ProbeBoard;
    type Currents = ProbeBoard;
    type BrushMain = ProbeBoard;
    type BrushSides = ProbeBoard;
    type Vacuum = ProbeBoard;
    type Charger = ProbeBoard;
    type DockContacts = ProbeBoard;
    type DockBeams = ProbeBoard;
    type DustBox = Absent;
    type Beeper = ProbeBoard;
    type Lights = ProbeBoard;
    type Buttons = ProbeBoard;
    type Probe = ProbeBoard;
}

impl Clock for ProbeBoard {
    fn tick(&mut self) -> Tick {
        Tick(read())
    }
}

impl Link for ProbeBoard {
    fn receive(&mut self) -> Option<Received> {
        bit(8).then(|| Received::Byte(read() as u8))
    }

    fn transmit(&mut self, bytes: &[u8]) -> usize {
        bytes.iter().for_each(|byte| write(u32::from(*byte)));
        bytes.len()
    }
}

impl WheelMotors for ProbeBoard {
    fn drive(&mut self, left: WheelDrive, right: WheelDrive) {
        write(left.duty().millionths() as u32);
        write(right.duty().millionths() as u32);
    }
}

impl ResetRecord for ProbeBoard {
    fn cause(&mut self) -> ResetCause {
        ResetCause::Unknown
    }

    fn boot_count(&mut self) -> u32 {
        read()
    }

    fn recent(&mut self) -> u8 {
        read() as u8
    }

    fn forget_recent(&mut self) {
        write(0);
    }
}

impl KeptMemory for ProbeBoard {
    const PRESENT: bool = true;

    fn load(&mut self) -> Option<KeptWords> {
        bit(10).then(|| core::array::from_fn(|_| read()))
    }

    fn store(&mut self, words: &KeptWords) {
        words.iter().for_each(|word| write(*word));
    }
}

impl HardwareChecks for ProbeBoard {
    fn stands(&mut self, fault: HardwareFault) -> bool {
        bit(11 + fault as u8)
    }
}

impl Watchdog for ProbeBoard {
    fn feed(&mut self) {
        write(1);
    }
}

impl Encoders for ProbeBoard {
    const PRESENT: bool = true;

    fn counts(&mut self) -> WheelCounts {
        WheelCounts {
            left: read() as i32,
            right: read() as i32,
        }
    }
}

impl BumperSwitches for ProbeBoard {
    const ZONES: u8 = 2;

    fn pressed(&mut self) -> Bumpers {
        Bumpers {
            left: bit(0),
            right: bit(1),
        }
    }
}

impl CliffSensors for ProbeBoard {
    const FITTED: Cliffs = Cliffs {
        left: true,
        middle: true,
        right: true,
    };

    fn set_emitters(&mut self, emitters: Emitters) {
        write(u32::from(emitters == Emitters::On));
    }

    fn levels(&mut self) -> CliffLevels {
        CliffLevels {
            left: read() as u16,
            middle: read() as u16,
            right: read() as u16,
        }
    }
}

impl WheelDropSwitches for ProbeBoard {
    const SWITCHES: u8 = 2;

    fn hanging(&mut self) -> WheelDrops {
        WheelDrops {
            left: bit(2),
            right: bit(3),
        }
    }
}

impl ProximitySensors for ProbeBoard {
    const COUNT: u8 = 7;

    fn closeness(&mut self) -> [u8; PROXIMITY_SENSORS] {
        core::array::from_fn(|_| read() as u8)
    }
}

impl HeadingSensor for ProbeBoard {
    const PRESENT: bool = true;

    fn heading(&mut self) -> Option<Gyro> {
        bit(4).then(|| Gyro {
            heading: Angle(read() as i32),
            rate: AngularSpeed(read() as i32),
        })
    }
}

impl CurrentSense for ProbeBoard {
    const PRESENT: bool = true;

    fn currents(&mut self) -> Option<Currents> {
        Some(Currents {
            wheel_left: Current(read() as i32),
            wheel_right: Current(read() as i32),
            brush_main: Current(read() as i32),
        })
    }
}

impl CleaningMotor for ProbeBoard {
    const PRESENT: bool = true;

    fn set(&mut self, duty: Throttle) {
        write(duty.millionths() as u32);
    }
}

impl Charger for ProbeBoard {
    const PRESENT: bool = true;
    const CHARGES: bool = true;

    fn readings(&mut self) -> Option<ChargerReadings> {
        Some(ChargerReadings {
            pack_mv: read() as i32,
            input_mv: read() as i32,
            current_ma: read() as i32,
            temperature: Ok(Temperature(read() as i16)),
            age_ms: read(),
            adapter: bit(7),
        })
    }

    fn drive(&mut self, drive: ChargeDrive) {
        write(match drive {
            ChargeDrive::Off => 0,
            ChargeDrive::Duty(duty) => duty.millionths() as u32,
        });
    }

    fn ask_dock(&mut self, request: DockRequest) {
        write(request as u32);
    }
}

impl PinProbe for ProbeBoard {
    const PRESENT: bool = true;

    fn analog(&mut self) -> [u16; PROBE_CHANNELS] {
        core::array::from_fn(|_| read() as u16)
    }

    fn encoders(&mut self) -> EncoderProbe {
        EncoderProbe {
            left: read() as i32,
            right: read() as i32,
            left_illegal: read(),
            right_illegal: read(),
            brush: Some(read()),
        }
    }

    fn lines(&mut self) -> [u16; PROBE_PORTS] {
        core::array::from_fn(|_| read() as u16)
    }

    fn buttons(&mut self) -> ButtonProbe {
        ButtonProbe {
            level: read() as u16,
            pressed: bit(8),
        }
    }

    fn open_serial(&mut self, port: u8, baud: u32) -> Result<(), Refusal> {
        write(u32::from(port) ^ baud);
        if bit(9) { Ok(()) } else { Err(Refusal::Absent) }
    }

    fn read_serial(&mut self, bytes: &mut [u8]) -> usize {
        bytes.fill(read() as u8);
        bytes.len()
    }

    fn serial_lost(&mut self) -> u32 {
        read()
    }

    fn close_serial(&mut self) {
        write(0);
    }
}

impl DockContacts for ProbeBoard {
    fn closed(&mut self) -> bool {
        bit(5)
    }
}

impl DockBeams for ProbeBoard {
    const COUNT: u8 = 4;

    fn symbols(&mut self) -> DockReceivers {
        core::array::from_fn(|_| read() as u8)
    }
}

impl DustBox for ProbeBoard {
    fn inserted(&mut self) -> Option<bool> {
        Some(bit(6))
    }
}

impl Beeper for ProbeBoard {
    const PRESENT: bool = true;

    fn sound(&mut self, pitch: Frequency, volume: Ratio) {
        write(pitch.0 as u32 ^ volume.millionths() as u32);
    }

    fn silence(&mut self) {
        write(0);
    }
}

impl Lights for ProbeBoard {
    const COUNT: u8 = 8;

    fn set(&mut self, light: u8, brightness: Ratio) {
        write(u32::from(light) ^ brightness.millionths() as u32);
    }
}

impl Buttons for ProbeBoard {
    const COUNT: u8 = 3;

    fn down(&mut self) -> u8 {
        read() as u8
    }
}

fn board() -> Board<ProbeBoard> {
    Board {
        clock: ProbeBoard,
        link: ProbeBoard,
        wheels: ProbeBoard,
        reset: ProbeBoard,
        watchdog: ProbeBoard,
        kept: ProbeBoard,
        checks: ProbeBoard,
        encoders: ProbeBoard,
        bumpers: ProbeBoard,
        cliffs: ProbeBoard,
        wheel_drops: ProbeBoard,
        proximity: ProbeBoard,
        gyro: ProbeBoard,
        currents: ProbeBoard,
        brush_main: ProbeBoard,
        brush_sides: ProbeBoard,
        vacuum: ProbeBoard,
        charger: ProbeBoard,
        dock_contacts: ProbeBoard,
        dock_beams: ProbeBoard,
        dust_box: Absent,
        beeper: ProbeBoard,
        lights: ProbeBoard,
        buttons: ProbeBoard,
        probe: ProbeBoard,
    }
}

/// Size of the robot's whole state on this target, where the measuring tool can read it.
#[unsafe(no_mangle)]
#[used]
static CORD_BYTES: u32 = size_of::<Cord<ProbeBoard>>() as u32;

/// Entry of the linked image.
#[unsafe(no_mangle)]
extern "C" fn __start() -> ! {
    let limits = Limits {
        speed_max: Speed(350_000),
        turn_max: AngularSpeed(1_500_000),
        track: Length(230_000),
        count_nm: 500_000,
        radius: Length(175_000),
        swath: Length(300_000),
    };
    let mut cord = Cord::new(board(), Parameters::for_machine("probe", "0.1.0", limits));
    loop {
        cord.step();
    }
}

/// What every board's handler does: all motors off, then wait for the watchdog.
#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    board().all_off();
    loop {}
}

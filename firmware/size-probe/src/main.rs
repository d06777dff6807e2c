//! A board whose every part is one memory cell, so that nothing of cordlib can be optimised away and nothing of a real
//! peripheral library is counted. It is linked and measured, never run.
#![no_std]
#![no_main]

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicU32, Ordering};

use cordlib::board::{
    Absent, Beeper, Board, BumperSwitches, Buttons, ChargeDrive, Charger, ChargerReadings, CleaningMotor,
    CliffLevels, CliffSensors, Clock, CurrentSense, DockBeams, DockContacts, DockRequest, DustBox, Emitters,
    Encoders, HeadingSensor, Lights, Link, Parts, Probe, ProximitySensors, Received, ResetRecord, Watchdog,
    WheelCounts, WheelDrive, WheelDropSwitches, WheelMotors,
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
struct Cell;

impl Parts for Cell {
    type Clock = Cell;
    type Link = Cell;
    type Wheels = Cell;
    type Reset = Cell;
    type Watchdog = Cell;
    type Encoders = Cell;
    type Bumpers = Cell;
    type Cliffs = Cell;
    type WheelDrops = Cell;
    type Proximity = Cell;
    type Gyro = Cell;
    type Currents = Cell;
    type BrushMain = Cell;
    type BrushSides = Cell;
    type Vacuum = Cell;
    type Charger = Cell;
    type DockContacts = Cell;
    type DockBeams = Cell;
    type DustBox = Absent;
    type Beeper = Cell;
    type Lights = Cell;
    type Buttons = Cell;
    type Probe = Cell;
}

impl Clock for Cell {
    fn tick(&mut self) -> Tick {
        Tick(read())
    }
}

impl Link for Cell {
    fn receive(&mut self) -> Option<Received> {
        bit(8).then(|| Received::Byte(read() as u8))
    }

    fn transmit(&mut self, bytes: &[u8]) -> usize {
        bytes.iter().for_each(|byte| write(u32::from(*byte)));
        bytes.len()
    }
}

impl WheelMotors for Cell {
    fn drive(&mut self, left: WheelDrive, right: WheelDrive) {
        write(left.duty().millionths() as u32);
        write(right.duty().millionths() as u32);
    }
}

impl ResetRecord for Cell {
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

impl Watchdog for Cell {
    fn feed(&mut self) {
        write(1);
    }
}

impl Encoders for Cell {
    const PRESENT: bool = true;

    fn counts(&mut self) -> WheelCounts {
        WheelCounts {
            left: read() as i32,
            right: read() as i32,
        }
    }
}

impl BumperSwitches for Cell {
    const ZONES: u8 = 2;

    fn pressed(&mut self) -> Bumpers {
        Bumpers {
            left: bit(0),
            right: bit(1),
        }
    }
}

impl CliffSensors for Cell {
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

impl WheelDropSwitches for Cell {
    const SWITCHES: u8 = 2;

    fn hanging(&mut self) -> WheelDrops {
        WheelDrops {
            left: bit(2),
            right: bit(3),
        }
    }
}

impl ProximitySensors for Cell {
    const COUNT: u8 = 7;

    fn closeness(&mut self) -> [u8; PROXIMITY_SENSORS] {
        core::array::from_fn(|_| read() as u8)
    }
}

impl HeadingSensor for Cell {
    const PRESENT: bool = true;

    fn heading(&mut self) -> Option<Gyro> {
        bit(4).then(|| Gyro {
            heading: Angle(read() as i32),
            rate: AngularSpeed(read() as i32),
        })
    }
}

impl CurrentSense for Cell {
    const PRESENT: bool = true;

    fn currents(&mut self) -> Option<Currents> {
        Some(Currents {
            wheel_left: Current(read() as i32),
            wheel_right: Current(read() as i32),
            brush_main: Current(read() as i32),
        })
    }
}

impl CleaningMotor for Cell {
    const PRESENT: bool = true;

    fn set(&mut self, duty: Throttle) {
        write(duty.millionths() as u32);
    }
}

impl Charger for Cell {
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

impl Probe for Cell {
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

impl DockContacts for Cell {
    fn closed(&mut self) -> bool {
        bit(5)
    }
}

impl DockBeams for Cell {
    const COUNT: u8 = 4;

    fn symbols(&mut self) -> DockReceivers {
        core::array::from_fn(|_| read() as u8)
    }
}

impl DustBox for Cell {
    fn inserted(&mut self) -> Option<bool> {
        Some(bit(6))
    }
}

impl Beeper for Cell {
    const PRESENT: bool = true;

    fn sound(&mut self, pitch: Frequency, volume: Ratio) {
        write(pitch.0 as u32 ^ volume.millionths() as u32);
    }

    fn silence(&mut self) {
        write(0);
    }
}

impl Lights for Cell {
    const COUNT: u8 = 8;

    fn set(&mut self, light: u8, brightness: Ratio) {
        write(u32::from(light) ^ brightness.millionths() as u32);
    }
}

impl Buttons for Cell {
    const COUNT: u8 = 3;

    fn down(&mut self) -> u8 {
        read() as u8
    }
}

fn board() -> Board<Cell> {
    Board {
        clock: Cell,
        link: Cell,
        wheels: Cell,
        reset: Cell,
        watchdog: Cell,
        encoders: Cell,
        bumpers: Cell,
        cliffs: Cell,
        wheel_drops: Cell,
        proximity: Cell,
        gyro: Cell,
        currents: Cell,
        brush_main: Cell,
        brush_sides: Cell,
        vacuum: Cell,
        charger: Cell,
        dock_contacts: Cell,
        dock_beams: Cell,
        dust_box: Absent,
        beeper: Cell,
        lights: Cell,
        buttons: Cell,
        probe: Cell,
    }
}

/// Size of the robot's whole state on this target, where the measuring tool can read it.
#[unsafe(no_mangle)]
#[used]
static CORD_BYTES: u32 = size_of::<Cord<Cell>>() as u32;

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

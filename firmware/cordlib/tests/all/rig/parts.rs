//! Board parts that are plain memory: tests write inputs and read outputs.

use std::cell::Cell;
use std::collections::VecDeque;

use cordlib::board::{
    Beeper, Board, BumperSwitches, Buttons, ChargeDrive, Charger, ChargerReadings, CleaningMotor,
    CliffLevels, CliffSensors, Clock, CurrentSense, DockBeams, DockContacts, DockRequest, DustBox, Emitters,
    Encoders, HardwareChecks, HardwareFault, HeadingSensor, KeptMemory, KeptWords, Lights, Link, Parts,
    PinProbe, ProximitySensors, Received, ResetRecord, Watchdog, WheelCounts, WheelDrive, WheelDropSwitches,
    WheelMotors,
};
use rvac_protocol::message::{
    Bumpers, ButtonProbe, Cliffs, Currents, DockReceivers, EncoderProbe, Gyro, Limits, PROBE_CHANNELS,
    PROBE_PORTS, PROXIMITY_SENSORS, Refusal, ResetCause, WheelDrops,
};
use rvac_units::{AngularSpeed, Frequency, Length, Ratio, Speed, Throttle, Tick};

/// What the machine of these tests can do.
pub const LIMITS: Limits = Limits {
    speed_max: Speed(350_000),
    turn_max: AngularSpeed(1_500_000),
    track: Length(230_000),
    count_nm: 500_000,
    radius: Length(175_000),
    swath: Length(300_000),
};

thread_local! {
    /// Calls into the board until one panics.
    static CALLS_LEFT: Cell<Option<u32>> = const { Cell::new(None) };
}

/// Makes the board panic at its `call`-th call from here on.
pub fn panic_at_call(call: u32) {
    CALLS_LEFT.set(Some(call));
}

/// Lets the board be.
pub fn never_panic() {
    CALLS_LEFT.set(None);
}

fn called() {
    let Some(left) = CALLS_LEFT.get() else {
        return;
    };
    assert!(left > 0, "injected");
    CALLS_LEFT.set(Some(left - 1));
}

/// A board of plain memory.
#[derive(Debug)]
pub struct Memory;

impl Parts for Memory {
    type Clock = Time;
    type Link = Wire;
    type Wheels = Bridges;
    type Reset = Record;
    type Watchdog = Fed;
    type Kept = Ram;
    type Checks = Checks;
    type Encoders = Counters;
    type Bumpers = Switches;
    type Cliffs = Floor;
    type WheelDrops = Drops;
    type Proximity = Sight;
    type Gyro = Needle;
    type Currents = Shunts;
    type BrushMain = Brush;
    type BrushSides = Brush;
    type Vacuum = Brush;
    type Charger = Pack;
    type DockContacts = Contacts;
    type DockBeams = Beams;
    type DustBox = DustBoxSwitch;
    type Beeper = Speaker;
    type Lights = Lamps;
    type Buttons = Keys;
    type Probe = Pins;
}

/// A board at rest whose line to the host takes so many bytes at a time.
pub fn board(room: usize) -> Board<Memory> {
    Board {
        clock: Time(0),
        link: Wire {
            to_robot: VecDeque::new(),
            to_host: Vec::new(),
            room,
        },
        wheels: Bridges {
            left: WheelDrive::Brake,
            right: WheelDrive::Brake,
        },
        reset: Record::default(),
        watchdog: Fed::default(),
        kept: Ram::default(),
        checks: Checks::default(),
        encoders: Counters::default(),
        bumpers: Switches::default(),
        cliffs: Floor {
            missing: Cliffs::default(),
            stuck_left: None,
            emitters: Emitters::On,
        },
        wheel_drops: Drops::default(),
        proximity: Sight,
        gyro: Needle::default(),
        currents: Shunts::default(),
        brush_main: Brush::default(),
        brush_sides: Brush::default(),
        vacuum: Brush::default(),
        charger: Pack::default(),
        dock_contacts: Contacts::default(),
        dock_beams: Beams,
        dust_box: DustBoxSwitch,
        beeper: Speaker::default(),
        lights: Lamps::default(),
        buttons: Keys::default(),
        probe: Pins::default(),
    }
}

#[derive(Debug, Default)]
pub struct Time(pub u32);

impl Clock for Time {
    fn tick(&mut self) -> Tick {
        called();
        Tick(self.0)
    }

    fn microseconds(&mut self) -> u16 {
        called();
        250
    }
}

/// Both directions of the serial line; `room` is what the transmit queue takes in one pass.
#[derive(Debug)]
pub struct Wire {
    pub to_robot: VecDeque<Received>,
    pub to_host: Vec<u8>,
    pub room: usize,
}

impl Link for Wire {
    fn receive(&mut self) -> Option<Received> {
        called();
        self.to_robot.pop_front()
    }

    fn transmit(&mut self, bytes: &[u8]) -> usize {
        called();
        let taken = bytes.len().min(self.room);
        self.to_host.extend_from_slice(&bytes[..taken]);
        taken
    }
}

#[derive(Debug)]
pub struct Bridges {
    pub left: WheelDrive,
    pub right: WheelDrive,
}

impl WheelMotors for Bridges {
    fn drive(&mut self, left: WheelDrive, right: WheelDrive) {
        called();
        self.left = left;
        self.right = right;
    }
}

#[derive(Debug)]
pub struct Record {
    pub recent: u8,
    pub cause: ResetCause,
}

impl Default for Record {
    fn default() -> Self {
        Self {
            recent: 0,
            cause: ResetCause::PowerOn,
        }
    }
}

impl ResetRecord for Record {
    fn cause(&mut self) -> ResetCause {
        called();
        self.cause
    }

    fn boot_count(&mut self) -> u32 {
        called();
        7
    }

    fn recent(&mut self) -> u8 {
        called();
        self.recent
    }

    fn forget_recent(&mut self) {
        called();
        self.recent = 0;
    }
}

/// What a reset leaves alone; `stores` counts.
#[derive(Clone, Copy, Debug, Default)]
pub struct Ram {
    pub words: Option<KeptWords>,
    pub stores: u32,
}

impl KeptMemory for Ram {
    const PRESENT: bool = true;

    fn load(&mut self) -> Option<KeptWords> {
        called();
        self.words
    }

    fn store(&mut self, words: &KeptWords) {
        called();
        self.words = Some(*words);
        self.stores += 1;
    }
}

/// Faults whose causes stand.
#[derive(Debug, Default)]
pub struct Checks(pub Vec<HardwareFault>);

impl HardwareChecks for Checks {
    fn stands(&mut self, fault: HardwareFault) -> bool {
        called();
        self.0.contains(&fault)
    }
}

#[derive(Debug, Default)]
pub struct Fed(pub u32);

impl Watchdog for Fed {
    fn feed(&mut self) {
        called();
        self.0 += 1;
    }
}

#[derive(Debug, Default)]
pub struct Counters(pub WheelCounts);

impl Encoders for Counters {
    const PRESENT: bool = true;

    fn counts(&mut self) -> WheelCounts {
        called();
        self.0
    }
}

#[derive(Debug, Default)]
pub struct Switches(pub Bumpers);

impl BumperSwitches for Switches {
    const ZONES: u8 = 2;

    fn pressed(&mut self) -> Bumpers {
        called();
        self.0
    }
}

/// Receivers over a floor that reflects 600 of 1023 when lit, with 40 of ambient light. `stuck` freezes one at a level.
#[derive(Debug)]
pub struct Floor {
    pub missing: Cliffs,
    pub stuck_left: Option<u16>,
    pub emitters: Emitters,
}

impl CliffSensors for Floor {
    const FITTED: Cliffs = Cliffs {
        left: true,
        middle: true,
        right: true,
    };

    fn set_emitters(&mut self, emitters: Emitters) {
        called();
        self.emitters = emitters;
    }

    fn levels(&mut self) -> CliffLevels {
        called();
        let level = |missing: bool| match (self.emitters, missing) {
            (Emitters::On, false) => 600,
            (Emitters::On, true) | (Emitters::Off, _) => 40,
        };
        CliffLevels {
            left: self.stuck_left.unwrap_or_else(|| level(self.missing.left)),
            middle: level(self.missing.middle),
            right: level(self.missing.right),
        }
    }
}

#[derive(Debug, Default)]
pub struct Drops(pub WheelDrops);

impl WheelDropSwitches for Drops {
    const SWITCHES: u8 = 2;

    fn hanging(&mut self) -> WheelDrops {
        called();
        self.0
    }
}

#[derive(Debug, Default)]
pub struct Sight;

impl ProximitySensors for Sight {
    const COUNT: u8 = 7;

    fn closeness(&mut self) -> [u8; PROXIMITY_SENSORS] {
        called();
        [0, 1, 2, 3, 4, 5, 6, 0]
    }
}

#[derive(Debug, Default)]
pub struct Needle(pub Option<Gyro>);

impl HeadingSensor for Needle {
    const PRESENT: bool = true;

    fn heading(&mut self) -> Option<Gyro> {
        called();
        self.0
    }
}

#[derive(Debug, Default)]
pub struct Shunts(pub Currents);

impl CurrentSense for Shunts {
    const PRESENT: bool = true;

    fn currents(&mut self) -> Option<Currents> {
        called();
        Some(self.0)
    }
}

#[derive(Debug, Default)]
pub struct Brush {
    pub duty: Throttle,
    pub pulses: Option<u32>,
}

impl CleaningMotor for Brush {
    const PRESENT: bool = true;

    fn set(&mut self, duty: Throttle) {
        called();
        self.duty = duty;
    }

    fn pulses(&mut self) -> Option<u32> {
        called();
        self.pulses
    }
}

#[derive(Debug, Default)]
pub struct Pack {
    pub readings: Option<ChargerReadings>,
    pub drive: ChargeDrive,
    pub request: DockRequest,
}

impl Charger for Pack {
    const PRESENT: bool = true;
    const CHARGES: bool = true;

    fn readings(&mut self) -> Option<ChargerReadings> {
        called();
        self.readings
    }

    fn drive(&mut self, drive: ChargeDrive) {
        called();
        self.drive = drive;
    }

    fn ask_dock(&mut self, request: DockRequest) {
        called();
        self.request = request;
    }
}

#[derive(Debug, Default)]
pub struct Contacts(pub bool);

impl DockContacts for Contacts {
    fn closed(&mut self) -> bool {
        called();
        self.0
    }
}

#[derive(Debug, Default)]
pub struct Beams;

impl DockBeams for Beams {
    const COUNT: u8 = 4;

    fn symbols(&mut self) -> DockReceivers {
        called();
        [0; 4]
    }
}

#[derive(Debug, Default)]
pub struct DustBoxSwitch;

impl DustBox for DustBoxSwitch {
    fn inserted(&mut self) -> Option<bool> {
        called();
        Some(true)
    }
}

#[derive(Debug, Default)]
pub struct Speaker {
    pub tone: Option<Frequency>,
    pub played: Vec<i32>,
}

impl Beeper for Speaker {
    const PRESENT: bool = true;

    fn sound(&mut self, pitch: Frequency, _: Ratio) {
        called();
        self.tone = Some(pitch);
        self.played.push(pitch.0);
    }

    fn silence(&mut self) {
        called();
        self.tone = None;
    }
}

#[derive(Debug, Default)]
pub struct Lamps(pub [Ratio; 5]);

impl Lights for Lamps {
    const COUNT: u8 = 5;

    fn set(&mut self, light: u8, brightness: Ratio) {
        called();
        self.0[usize::from(light)] = brightness;
    }
}

/// Buttons; `any` is the line that tells of a press without telling of which.
#[derive(Debug, Default)]
pub struct Keys {
    pub down: u8,
    pub any: bool,
}

impl Buttons for Keys {
    const COUNT: u8 = 3;

    fn down(&mut self) -> u8 {
        called();
        self.down
    }

    fn any_down(&mut self) -> bool {
        called();
        self.any || self.down != 0
    }
}

/// Raw readings; a serial port with number 1 that makes up to 115,200 baud.
#[derive(Debug, Default)]
pub struct Pins {
    pub analog: [u16; PROBE_CHANNELS],
    pub encoders: EncoderProbe,
    pub lines: [u16; PROBE_PORTS],
    pub buttons: ButtonProbe,
    /// What the port has received; `None` while it is closed.
    pub serial: Option<VecDeque<u8>>,
    pub lost: u32,
    pub opened: u32,
}

impl PinProbe for Pins {
    const PRESENT: bool = true;

    fn analog(&mut self) -> [u16; PROBE_CHANNELS] {
        called();
        self.analog
    }

    fn encoders(&mut self) -> EncoderProbe {
        called();
        self.encoders
    }

    fn lines(&mut self) -> [u16; PROBE_PORTS] {
        called();
        self.lines
    }

    fn buttons(&mut self) -> ButtonProbe {
        called();
        self.buttons
    }

    fn open_serial(&mut self, port: u8, baud: u32) -> Result<(), Refusal> {
        called();
        if port != 1 {
            return Err(Refusal::Absent);
        }
        if baud > 115_200 {
            return Err(Refusal::Range);
        }
        self.serial = Some(VecDeque::new());
        self.opened += 1;
        Ok(())
    }

    fn read_serial(&mut self, bytes: &mut [u8]) -> usize {
        called();
        let queue = self.serial.as_mut().expect("only an open port is read");
        let taken = bytes.len().min(queue.len());
        for (place, byte) in bytes.iter_mut().zip(queue.drain(..taken)) {
            *place = byte;
        }
        taken
    }

    fn serial_lost(&mut self) -> u32 {
        called();
        self.lost
    }

    fn close_serial(&mut self) {
        called();
        self.serial = None;
    }
}

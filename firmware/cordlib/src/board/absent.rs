//! The part that is absent.

use rvac_protocol::message::{
    Bumpers, ButtonProbe, Cliffs, Currents, DockReceivers, EncoderProbe, Gyro, PROBE_CHANNELS, PROBE_PORTS,
    PROXIMITY_SENSORS, Refusal, WheelDrops,
};
use rvac_units::{Frequency, Ratio, Throttle};

use super::{
    Beeper, BumperSwitches, Buttons, ChargeDrive, Charger, ChargerReadings, CleaningMotor, CliffLevels,
    CliffSensors, CurrentSense, DockBeams, DockContacts, DockRequest, DustBox, Emitters, Encoders,
    HardwareChecks, HardwareFault, HeadingSensor, KeptMemory, KeptWords, Lights, PinProbe, ProximitySensors,
    WheelCounts, WheelDropSwitches,
};

/// Stands for a part the machine lacks. Commands to it are refused as `absent`, and the description says so.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Absent;

impl KeptMemory for Absent {
    const PRESENT: bool = false;

    fn load(&mut self) -> Option<KeptWords> {
        None
    }

    fn store(&mut self, _: &KeptWords) {}
}

impl HardwareChecks for Absent {
    fn stands(&mut self, _: HardwareFault) -> bool {
        false
    }
}

impl Encoders for Absent {
    const PRESENT: bool = false;

    fn counts(&mut self) -> WheelCounts {
        WheelCounts::default()
    }
}

impl BumperSwitches for Absent {
    const ZONES: u8 = 0;

    fn pressed(&mut self) -> Bumpers {
        Bumpers::default()
    }
}

impl CliffSensors for Absent {
    const FITTED: Cliffs = Cliffs {
        left: false,
        middle: false,
        right: false,
    };

    fn set_emitters(&mut self, _: Emitters) {}

    fn levels(&mut self) -> CliffLevels {
        CliffLevels::default()
    }
}

impl WheelDropSwitches for Absent {
    const SWITCHES: u8 = 0;

    fn hanging(&mut self) -> WheelDrops {
        WheelDrops::default()
    }
}

impl DustBox for Absent {
    fn inserted(&mut self) -> Option<bool> {
        None
    }
}

impl ProximitySensors for Absent {
    const COUNT: u8 = 0;

    fn closeness(&mut self) -> [u8; PROXIMITY_SENSORS] {
        [0; PROXIMITY_SENSORS]
    }
}

impl HeadingSensor for Absent {
    const PRESENT: bool = false;

    fn heading(&mut self) -> Option<Gyro> {
        None
    }
}

impl CurrentSense for Absent {
    const PRESENT: bool = false;

    fn currents(&mut self) -> Option<Currents> {
        None
    }
}

impl Charger for Absent {
    const PRESENT: bool = false;
    const CHARGES: bool = false;

    fn readings(&mut self) -> Option<ChargerReadings> {
        None
    }

    fn drive(&mut self, _: ChargeDrive) {}

    fn ask_dock(&mut self, _: DockRequest) {}
}

impl PinProbe for Absent {
    const PRESENT: bool = false;

    fn analog(&mut self) -> [u16; PROBE_CHANNELS] {
        [0; PROBE_CHANNELS]
    }

    fn encoders(&mut self) -> EncoderProbe {
        EncoderProbe::default()
    }

    fn lines(&mut self) -> [u16; PROBE_PORTS] {
        [0; PROBE_PORTS]
    }

    fn buttons(&mut self) -> ButtonProbe {
        ButtonProbe::default()
    }

    fn open_serial(&mut self, _: u8, _: u32) -> Result<(), Refusal> {
        Err(Refusal::Absent)
    }

    fn read_serial(&mut self, _: &mut [u8]) -> usize {
        0
    }

    fn serial_lost(&mut self) -> u32 {
        0
    }

    fn close_serial(&mut self) {}
}

impl CleaningMotor for Absent {
    const PRESENT: bool = false;

    fn set(&mut self, _: Throttle) {}
}

impl DockContacts for Absent {
    fn closed(&mut self) -> bool {
        false
    }
}

impl DockBeams for Absent {
    const COUNT: u8 = 0;

    fn symbols(&mut self) -> DockReceivers {
        [0; 4]
    }
}

impl Beeper for Absent {
    const PRESENT: bool = false;

    fn sound(&mut self, _: Frequency, _: Ratio) {}

    fn silence(&mut self) {}
}

impl Lights for Absent {
    const COUNT: u8 = 0;

    fn set(&mut self, _: u8, _: Ratio) {}
}

impl Buttons for Absent {
    const COUNT: u8 = 0;

    fn down(&mut self) -> u8 {
        0
    }
}

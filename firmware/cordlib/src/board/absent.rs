//! The part that is not there.

use rvac_protocol::message::{
    Battery, Bumpers, Cliffs, Currents, DockReceivers, Gyro, PROXIMITY_SENSORS, WheelDrops,
};
use rvac_units::{Frequency, Ratio, Throttle};

use super::{
    BatteryGauge, Beeper, BumperSwitches, Buttons, CleaningMotor, CliffLevels, CliffSensors, CurrentSense,
    DockBeams, DockContacts, DustBox, Emitters, Encoders, HeadingSensor, Lights, ProximitySensors,
    WheelCounts, WheelDropSwitches,
};

/// Stands for a part the machine lacks. Commands to it are refused as `absent`, and the description says so.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Absent;

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

impl BatteryGauge for Absent {
    const PRESENT: bool = false;
    const CHARGES: bool = false;

    fn battery(&mut self) -> Option<Battery> {
        None
    }
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

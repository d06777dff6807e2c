//! How an emulated robot is made.

use monitor::Bridges;

use crate::board::calibration::{CalibrationValues, Particulars, erase_record, has_record, put_record};
use crate::board::gyro_frame::GyroFitted;
use crate::board::pinout::Pinout;
use crate::board::serial::HostRate;
use crate::board::wiring::Wiring;
use crate::board::{BoardError, BoardLink};
use crate::image::{Image, ImageError};

/// Which calibration record the robot's flash holds.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum CalibrationChoice {
    /// What the image brings along; if it brings nothing, everything was measured.
    #[default]
    Complete,
    /// Everything was measured except these values.
    Without(Vec<String>),
    /// These values, as an owner has measured them; all others are unknown.
    Measured(Vec<(String, i32)>),
    /// Nothing: the page is erased.
    Absent,
}

/// How an emulated robot is made.
#[derive(Clone, Debug, PartialEq)]
pub struct EmulatedSettings {
    /// Speed of the host's UART.
    pub rate: HostRate,
    /// Seed of the line's damage, of the converter's noise and of bounces.
    pub seed: u64,
    /// Contacts bounce for up to so many microseconds after a change; 0 = not at all.
    pub bounce_us: u32,
    /// What the wheel bridges are like.
    pub bridges: Bridges,
    /// The board is that of this number, while its record is that of the original; `None` = they agree.
    pub miscalibration: Option<u64>,
}

impl Default for EmulatedSettings {
    fn default() -> Self {
        Self {
            rate: HostRate::exact(230_400),
            seed: 1,
            bounce_us: 0,
            bridges: Bridges::Sound,
            miscalibration: None,
        }
    }
}

/// Why there is no robot.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BlueprintError {
    /// The board's description is wrong.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The calibration record does not fit into the image.
    #[error(transparent)]
    Image(#[from] ImageError),
}

/// Everything of a robot that does not change from run to run: its program, its calibration, its board. Read once, for any
/// number of robots.
#[derive(Clone, Debug)]
pub struct Blueprint {
    pub(super) image: Image,
    pub(super) wiring: Wiring,
    pub(super) particulars: Particulars,
    pub(super) gyro: GyroFitted,
}

impl Blueprint {
    /// The SR8730's board with this program and record.
    ///
    /// # Errors
    /// When the project's own description of the board is wrong.
    pub fn sr8730(mut image: Image, record: &CalibrationChoice) -> Result<Self, BlueprintError> {
        let calibration = CalibrationValues::sr8730()?;
        match record {
            CalibrationChoice::Complete if has_record(&image) => {}
            CalibrationChoice::Complete => put_record(&mut image, &calibration.record())?,
            CalibrationChoice::Without(unknown) => {
                let unknown: Vec<&str> = unknown.iter().map(String::as_str).collect();
                put_record(&mut image, &calibration.record_without(&unknown))?;
            }
            CalibrationChoice::Measured(values) => put_record(&mut image, &calibration.record_of(values))?,
            CalibrationChoice::Absent => erase_record(&mut image)?,
        }
        Ok(Self {
            image,
            wiring: Wiring::of(&Pinout::sr8730()?)?,
            particulars: Particulars::of(&calibration)?,
            gyro: GyroFitted::default(),
        })
    }

    /// The same program and record in a board that is wired like this and has these particulars.
    ///
    /// # Errors
    /// When the wiring lacks something that the robot needs.
    pub fn in_board(self, pinout: &Pinout, particulars: Particulars) -> Result<Self, BlueprintError> {
        Ok(Self {
            wiring: Wiring::of(pinout)?,
            particulars,
            ..self
        })
    }

    /// The same with another link to the Linux board, for which the program was built.
    ///
    /// # Errors
    /// When the project's own description of the board is wrong.
    pub fn linked_by(self, link: BoardLink) -> Result<Self, BlueprintError> {
        Ok(Self {
            wiring: link.wiring()?,
            ..self
        })
    }

    /// The same with this gyro module.
    #[must_use]
    pub fn with_gyro(self, gyro: GyroFitted) -> Self {
        Self { gyro, ..self }
    }
}

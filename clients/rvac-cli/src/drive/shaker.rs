//! Lets a gamepad rumble, if it can, when the bumper is pressed.

use std::io;

use evdev::{FFEffect, FFEffectCode, FFEffectData, FFEffectKind, FFReplay, FFTrigger};

/// Rumble of a pad at a bump: as long and as strong as in the panel.
const BUMP: FFEffectData = FFEffectData {
    direction: 0,
    trigger: FFTrigger {
        button: 0,
        interval: 0,
    },
    replay: FFReplay {
        length: 250,
        delay: 0,
    },
    kind: FFEffectKind::Rumble {
        strong_magnitude: u16::MAX,
        weak_magnitude: u16::MAX / 5 * 3,
    },
};

/// A pad that can shake. The kernel forgets the effect when this is dropped.
#[derive(Debug)]
pub(super) struct Shaker(FFEffect);

impl Shaker {
    /// None for a pad without such motors, or one that this user may only read.
    pub(super) fn of(device: &mut evdev::Device) -> Option<Self> {
        let can_rumble = device
            .supported_ff()
            .is_some_and(|effects| effects.contains(FFEffectCode::FF_RUMBLE));
        if !can_rumble {
            return None;
        }
        device.upload_ff_effect(BUMP).ok().map(Self)
    }

    /// Shakes once.
    ///
    /// # Errors
    /// When the pad is gone.
    pub(super) fn shake(&mut self) -> io::Result<()> {
        self.0.play(1)
    }
}

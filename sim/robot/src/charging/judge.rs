//! Whether the switch was ever driven against what is really so in the pack. The bounds are wider than the charger's own,
//! by what its sensors may be wrong.

/// Hottest and coldest cell that may get current, degrees Celsius.
const HOTTEST_C: f64 = 55.0;
const COLDEST_C: f64 = -5.0;
/// No pack gets current above this: 1.75 V a cell.
const HIGHEST_V: f64 = 21.0;
const HIGHEST_A: f64 = 1.4;
/// Time to react, ms: two seconds for what is averaged over one, 100 ms and an envelope for current and contacts.
const SLOW_MS: u32 = 2_000;
const FAST_MS: u32 = 140;
/// No charge lasts longer, and a rest of half an hour begins another, ms.
const LONGEST_MS: u32 = 12_960_000;
const REST_MS: u32 = 1_800_000;

/// What the pack is really like while the switch is driven or not.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scene {
    pub(crate) driven: bool,
    pub(crate) supplied: bool,
    pub(crate) hottest_c: f64,
    pub(crate) pack_v: f64,
    pub(crate) current_a: f64,
}

/// Counts breaches.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Judge {
    standing_ms: [u32; 4],
    charged_ms: u32,
    rest_ms: u32,
    broken: [bool; 5],
    pub(crate) violations: u32,
    /// Longest time in which the switch was driven without a rest.
    pub(crate) longest_ms: u32,
}

impl Judge {
    pub(crate) fn look(&mut self, scene: &Scene, elapsed_ms: u32) {
        let causes = [
            (!scene.supplied, FAST_MS),
            (!(COLDEST_C..HOTTEST_C).contains(&scene.hottest_c), SLOW_MS),
            (scene.pack_v > HIGHEST_V, SLOW_MS),
            (scene.current_a > HIGHEST_A, FAST_MS),
        ];
        let mut broken = [false; 5];
        for (index, (cause, limit_ms)) in causes.into_iter().enumerate() {
            let standing = &mut self.standing_ms[index];
            *standing = if scene.driven && cause {
                *standing + elapsed_ms
            } else {
                0
            };
            broken[index] = *standing > limit_ms;
        }
        if scene.driven {
            self.charged_ms += elapsed_ms;
            self.rest_ms = 0;
        } else {
            self.rest_ms += elapsed_ms;
            if self.rest_ms > REST_MS {
                self.charged_ms = 0;
            }
        }
        self.longest_ms = self.longest_ms.max(self.charged_ms);
        broken[4] = self.charged_ms > LONGEST_MS;
        for (now, before) in broken.iter().zip(&self.broken) {
            self.violations += u32::from(*now && !before);
        }
        self.broken = broken;
    }
}

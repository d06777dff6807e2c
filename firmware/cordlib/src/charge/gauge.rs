//! State of charge. The current out of the pack cannot be measured, so the estimate integrates the nominal loads of the
//! parts that are switched on, and is pulled towards the state of charge that the voltage shows. One curve serves charging
//! and discharging, so that its end points agree.

use rvac_units::Ratio;

use crate::limit::within;
use crate::parameters::PackParameters;

use super::meter::Averages;

/// Millivolts of one cell and its charge in millionths: a resting NiMH cell at room temperature.
const CURVE: [(i32, i32); 11] = [
    (1_000, 0),
    (1_190, 100_000),
    (1_220, 200_000),
    (1_235, 300_000),
    (1_245, 400_000),
    (1_255, 500_000),
    (1_265, 600_000),
    (1_280, 700_000),
    (1_300, 800_000),
    (1_335, 900_000),
    (1_400, 1_000_000),
];
const WHOLE: i64 = 1_000_000;
/// Charging efficiency, in hundredths.
const STORED: i64 = 93;
/// While the pack charges, the estimate stays below this until the charge has ended well.
const ALMOST: i64 = 990_000;
/// Each second the estimate moves towards the value by voltage by one in this many of the difference.
const PULL: i64 = 600;
/// Milliseconds and millionths to milliampere hours.
const MS_PER_H: i64 = 3_600_000;

/// Load and charging of the pack.
#[derive(Clone, Copy, Debug)]
pub(super) struct PackLoad {
    /// Estimated load of the machine.
    pub(super) load_ma: i32,
    /// The pack is being charged.
    pub(super) charging: bool,
}

/// The estimate in millionths.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Gauge {
    charge: Option<i64>,
}

impl Gauge {
    /// Takes the averages of a second.
    pub(super) fn each_second(&mut self, averages: &Averages, load: PackLoad, pack: &PackParameters) {
        let PackLoad { load_ma, charging } = load;
        let sag_mv = i64::from(load_ma).saturating_mul(i64::from(pack.resistance_mohm)) / 1_000;
        let open_mv = averages
            .pack_mv
            .saturating_add(i32::try_from(sag_mv).unwrap_or(0));
        let by_voltage = by_voltage(open_mv, pack.cells);
        let Some(charge) = self.charge else {
            self.charge = Some(by_voltage);
            return;
        };
        let in_ma = i64::from(averages.current_ma.max(0)).saturating_mul(STORED) / 100;
        let net_ma = in_ma.saturating_sub(i64::from(load_ma));
        let capacity_ma_ms = i64::from(pack.capacity_mah.max(1)).saturating_mul(MS_PER_H);
        let change = net_ma
            .saturating_mul(i64::from(averages.elapsed_ms))
            .saturating_mul(WHOLE)
            / capacity_ma_ms.max(1);
        let counted = charge.saturating_add(change);
        self.charge = Some(if charging {
            within(counted, 0, ALMOST.max(charge))
        } else {
            let pulled = counted.saturating_add(by_voltage.saturating_sub(counted) / PULL);
            within(pulled, 0, WHOLE)
        });
    }

    /// A charge has ended well.
    pub(super) const fn fill(&mut self) {
        self.charge = Some(WHOLE);
    }

    /// The estimate; `None` in the first second, before there is one.
    pub(super) fn charge(&self) -> Option<Ratio> {
        let millionths = i32::try_from(self.charge?).ok()?;
        Ratio::from_millionths(millionths).ok()
    }
}

/// State of charge by the voltage of a resting pack, in millionths.
fn by_voltage(pack_mv: i32, cells: u8) -> i64 {
    let cell_mv = pack_mv / i32::from(cells.max(1));
    let (mut below_mv, mut below) = (0, 0);
    for (above_mv, above) in CURVE {
        if cell_mv < above_mv {
            let span_mv = i64::from(above_mv.saturating_sub(below_mv).max(1));
            let above_mv_of_point = i64::from(cell_mv.saturating_sub(below_mv).max(0));
            let rise = i64::from(above.max(below).saturating_sub(below));
            return i64::from(below).saturating_add(above_mv_of_point.saturating_mul(rise) / span_mv);
        }
        (below_mv, below) = (above_mv, above);
    }
    WHOLE
}

#[cfg(test)]
mod tests {
    use super::{CURVE, Gauge, PackLoad, by_voltage};
    use crate::charge::meter::Averages;
    use crate::parameters::PackParameters;

    const PACK: PackParameters = PackParameters::NIMH_12;

    fn averages(pack_mv: i32, current_ma: i32) -> Averages {
        Averages {
            elapsed_ms: 1_000,
            pack_mv,
            current_ma,
            ..Averages::default()
        }
    }

    #[test]
    fn the_curve_rises_from_empty_to_full_and_both_ends_are_reached() {
        assert_eq!(by_voltage(12_000, 12), 0);
        assert_eq!(by_voltage(16_800, 12), 1_000_000);
        assert_eq!(by_voltage(20_000, 12), 1_000_000);
        assert_eq!(by_voltage(-5, 12), 0);
        let rising = CURVE
            .windows(2)
            .all(|pair| pair[0].0 < pair[1].0 && pair[0].1 < pair[1].1);
        assert!(rising);
        let mut last = 0;
        for mv in (11_000..18_000).step_by(10) {
            let charge = by_voltage(mv, 12);
            assert!(
                charge >= last && charge - last < 20_000,
                "{mv} mV: {last} to {charge}"
            );
            last = charge;
        }
    }

    #[test]
    fn a_charge_counts_up_and_is_full_only_when_it_has_ended() {
        let mut gauge = Gauge::default();
        assert!(gauge.charge().is_none());
        gauge.each_second(
            &averages(14_640, 0),
            PackLoad {
                load_ma: 0,
                charging: false,
            },
            &PACK,
        );
        assert_eq!(gauge.charge().unwrap().millionths(), 200_000);
        for _ in 0..3_600 {
            gauge.each_second(
                &averages(17_000, 950),
                PackLoad {
                    load_ma: 15,
                    charging: true,
                },
                &PACK,
            );
        }
        let after_an_hour = gauge.charge().unwrap().millionths();
        assert!((620_000..640_000).contains(&after_an_hour), "{after_an_hour}");
        for _ in 0..7_200 {
            gauge.each_second(
                &averages(17_500, 950),
                PackLoad {
                    load_ma: 15,
                    charging: true,
                },
                &PACK,
            );
        }
        assert_eq!(gauge.charge().unwrap().millionths(), 990_000);
        gauge.fill();
        assert_eq!(gauge.charge().unwrap().millionths(), 1_000_000);
    }

    #[test]
    fn a_load_is_counted_and_its_sag_is_not_taken_for_emptiness() {
        let mut gauge = Gauge::default();
        let load_ma = 1_500;
        let sag_mv = load_ma * i32::from(PACK.resistance_mohm) / 1_000;
        gauge.each_second(
            &averages(15_180, 0),
            PackLoad {
                load_ma: 0,
                charging: false,
            },
            &PACK,
        );
        let before = gauge.charge().unwrap().millionths();
        for _ in 0..600 {
            gauge.each_second(
                &averages(15_180 - sag_mv, 0),
                PackLoad {
                    load_ma,
                    charging: false,
                },
                &PACK,
            );
        }
        let after = gauge.charge().unwrap().millionths();
        assert!(
            (before - 130_000..before - 60_000).contains(&after),
            "{before} to {after}"
        );
    }
}

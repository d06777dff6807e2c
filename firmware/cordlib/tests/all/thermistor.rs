//! Temperatures of thermistors as they can be bought, by the equation of their data sheets.

use cordlib::thermistor::{Divider, MeasuredPoints, ThermistorCurve};

/// A thermistor with its resistors by the data sheets' equation: beta in kelvin, resistance at 25 °C, the one across it and
/// the one to the supply in kilo-ohm, and the converter's offset.
#[derive(Clone, Copy, Debug)]
struct Sensor {
    beta: f64,
    room: f64,
    across: f64,
    supply: f64,
    offset: f64,
}

const NOMINAL: Sensor = Sensor {
    beta: 3_435.0,
    room: 10.0,
    across: 10.0,
    supply: 1.5,
    offset: 0.0,
};

impl Sensor {
    fn counts(&self, celsius: f64) -> f64 {
        let kelvin = celsius + 273.15;
        let resistance = self.room * (self.beta * (1.0 / kelvin - 1.0 / 298.15)).exp();
        let lower = resistance * self.across / (resistance + self.across);
        1_024.0 * lower / (lower + self.supply) + self.offset
    }

    fn points(&self) -> MeasuredPoints {
        MeasuredPoints {
            ice: (self.counts(0.0) * 10.0).round() as i32,
            warm: (self.counts(40.0) * 10.0).round() as i32,
            warm_dc: 400,
        }
    }
}

/// The corners of what can be bought.
fn sensors() -> Vec<Sensor> {
    let corners = 0..32_u32;
    corners
        .map(|corner| {
            let pick = |bit: u32, low: f64, high: f64| if corner >> bit & 1 == 0 { low } else { high };
            Sensor {
                beta: pick(0, 3_380.0, 3_950.0),
                room: pick(1, 9.5, 10.5),
                across: pick(2, 9.9, 10.1),
                supply: pick(3, 1.485, 1.515),
                offset: pick(4, -3.0, 3.0),
            }
        })
        .collect()
}

const DIVIDER: Divider = Divider {
    across_ohm: 10_000,
    supply_ohm: 1_500,
};

const TEMPERATURES: [f64; 13] = [
    -10.0, -5.0, 0.0, 5.0, 10.0, 20.0, 25.0, 30.0, 40.0, 45.0, 50.0, 55.0, 60.0,
];

/// The range that a curve gives for a reading between two counts, as an average of many readings has it.
fn range(curve: &ThermistorCurve, counts: f64) -> (f64, f64) {
    let below = curve.temperature(counts.floor() as u16);
    let above = curve.temperature(counts.ceil() as u16);
    let share = counts - counts.floor();
    let mix = |low: f64, high: f64| low + (high - low) * share;
    (
        mix(below.coldest.as_celsius(), above.coldest.as_celsius()),
        mix(below.warmest.as_celsius(), above.warmest.as_celsius()),
    )
}

#[test]
fn without_measured_points_no_thermistor_is_outside_of_its_range() {
    let curve = ThermistorCurve::new(DIVIDER, None);
    for sensor in sensors() {
        for celsius in TEMPERATURES {
            let (coldest, warmest) = range(&curve, sensor.counts(celsius));
            assert!(coldest <= celsius + 0.05, "{sensor:?} at {celsius}: {coldest}");
            assert!(warmest >= celsius - 0.05, "{sensor:?} at {celsius}: {warmest}");
        }
    }
}

#[test]
fn with_measured_points_the_range_is_narrow_and_holds_the_truth() {
    for sensor in sensors() {
        let curve = ThermistorCurve::new(DIVIDER, Some(sensor.points()));
        for celsius in TEMPERATURES {
            let (coldest, warmest) = range(&curve, sensor.counts(celsius));
            assert!(
                coldest <= celsius && celsius <= warmest,
                "{sensor:?} at {celsius}: {coldest} to {warmest}"
            );
            let wide = if celsius < 0.0 { 9.0 } else { 6.0 };
            assert!(
                warmest - coldest < wide,
                "{sensor:?} at {celsius}: {coldest} to {warmest}"
            );
        }
    }
}

#[test]
fn the_middle_of_a_measured_range_follows_the_equation() {
    let curve = ThermistorCurve::new(DIVIDER, Some(NOMINAL.points()));
    for celsius in TEMPERATURES {
        let (coldest, warmest) = range(&curve, NOMINAL.counts(celsius));
        let middle = f64::midpoint(coldest, warmest);
        assert!((middle - celsius).abs() < 0.6, "{celsius}: {middle}");
    }
}

#[test]
fn points_that_no_thermistor_has_are_not_used() {
    let bad = [
        (8_517, 8_517, 400),
        (8_517, 8_600, 400),
        (8_517, 7_260, 150),
        (8_517, 6_000, 400),
    ];
    for (ice, warm, warm_dc) in bad {
        let points = MeasuredPoints { ice, warm, warm_dc };
        assert_eq!(
            ThermistorCurve::new(DIVIDER, Some(points)),
            ThermistorCurve::new(DIVIDER, None),
            "{points:?}"
        );
    }
}

#[test]
fn hotter_is_always_a_lower_reading() {
    for curve in [None, Some(NOMINAL.points())].map(|points| ThermistorCurve::new(DIVIDER, points)) {
        for reading in 100..880 {
            let [here, next] = [reading, reading + 1].map(|reading| curve.temperature(reading));
            assert!(here.coldest >= next.coldest && here.warmest >= next.warmest);
            assert!(here.coldest <= here.warmest);
        }
    }
}

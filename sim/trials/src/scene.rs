//! What the robot is doing when a fault happens.

use home::{Pack, PackMake, Pcg, SensorFault, SensorId};
use monitor::Bridges;
use pic32::board::MotorOutput;
use rvac_units::{AngularSpeed, Speed, Throttle};

use crate::testbed::{Fixture, Testbed, TestbedError};

/// Time in an operating state before the first event, in which the wheels reach their speed.
const SETTLE_MS: u64 = 1_200;
/// A charge begins within this time on the dock.
const BEGINS_MS: u64 = 60_000;
/// A session that is silent is over after this, and a person may type.
const SILENCE_MS: u64 = 2_300;
/// A rim that turns is faster than this, even where a person drives slowly.
const TURNS_M_PER_S: f64 = 0.02;
const PACKS: u64 = 0x0D0C;
/// Tenths of a degree: the pack below the two limits of heat, by more than a measured thermistor may be wrong.
const WARM_DC: i32 = 500;
const HOT_DC: i32 = 555;
/// What a person types to arm, and to drive slowly.
const TYPED_ARM: &str = r#"{"c":"arm"}"#;
const TYPED_DRIVE: &str = r#"{"c":"drive","v":0.05,"w":0,"ttl":1000}"#;

/// What the robot is doing when the event happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OperatingState {
    /// It stands still, and nobody has armed it.
    Locked,
    /// It stands still, armed.
    Standing,
    /// It drives ahead at 0.15 m/s.
    Driving,
    /// It drives ahead with brushes and suction on.
    Cleaning,
    /// The same with a pack of 50 °C.
    WarmCleaning,
    /// It stands with a pack of 55.5 °C.
    HotStanding,
    /// It turns on the spot.
    Turning,
    /// It drives ahead on bridges that ignore "brake".
    DeafBridges,
    /// A person without a host drives it by typing.
    ByHand,
    /// It charges on its dock.
    Charging,
}

impl OperatingState {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Locked,
        Self::Standing,
        Self::Driving,
        Self::Cleaning,
        Self::WarmCleaning,
        Self::HotStanding,
        Self::Turning,
        Self::DeafBridges,
        Self::ByHand,
        Self::Charging,
    ];

    /// A robot in this state.
    ///
    /// # Errors
    /// When it does not reach the state.
    pub fn set(self, fixture: &Fixture, number: u64, late_cycles: u64) -> Result<Testbed, TestbedError> {
        // A robot whose thermistor nobody has measured is careful: it neither works so near a limit nor charges as fast.
        let seed = match self {
            Self::WarmCleaning | Self::HotStanding | Self::Charging => 2 * number,
            _ => number,
        };
        let bridges = match self {
            Self::DeafBridges => Bridges::DeafToBrake,
            _ => Bridges::Sound,
        };
        let mut testbed = fixture.testbed(seed, bridges, late_cycles)?;
        match self {
            Self::Charging => put_on_dock(&mut testbed, seed),
            Self::WarmCleaning => show_temperature(&mut testbed, WARM_DC),
            Self::HotStanding => show_temperature(&mut testbed, HOT_DC),
            _ => {}
        }
        testbed.connect()?;
        self.begin(&mut testbed)?;
        testbed.robot_mut().watch_motors();
        testbed.run(SETTLE_MS);
        self.check(&testbed)?;
        Ok(testbed)
    }

    fn begin(self, testbed: &mut Testbed) -> Result<(), TestbedError> {
        let ahead = (Speed(150_000), AngularSpeed(0));
        match self {
            Self::Locked | Self::HotStanding => {}
            Self::Standing => arm(testbed),
            Self::Driving | Self::DeafBridges => {
                arm(testbed);
                testbed.drive(Some(ahead));
            }
            Self::Cleaning | Self::WarmCleaning => {
                arm(testbed);
                testbed.drive(Some(ahead));
                testbed.clean(Throttle::saturating_from_millionths(800_000));
            }
            Self::Turning => {
                arm(testbed);
                testbed.drive(Some((Speed(0), AngularSpeed(900_000))));
            }
            Self::ByHand => {
                testbed.set_speaking(false);
                testbed.run(SILENCE_MS);
                testbed.type_in(TYPED_ARM);
                testbed.run(100);
                testbed.keep_typing(Some(TYPED_DRIVE));
            }
            Self::Charging => wait_for_charge(testbed)?,
        }
        Ok(())
    }

    /// Whether the robot does what it was told, and nobody has seen a breach on the way.
    fn check(self, testbed: &Testbed) -> Result<(), TestbedError> {
        let robot = testbed.robot();
        if let Some(breach) = robot.monitor().violations().first() {
            return Err(TestbedError::Breach(breach.to_string()));
        }
        let wanted = !matches!(
            self,
            Self::Locked | Self::Standing | Self::HotStanding | Self::Charging
        );
        match (wanted, robot.wheels_driven()) {
            (true, false) => return Err(TestbedError::OperatingState("it does not drive")),
            (false, true) => return Err(TestbedError::OperatingState("it does not stand")),
            _ => {}
        }
        let truth = robot.world().truth();
        let rims = [truth.rim_left_m_per_s, truth.rim_right_m_per_s];
        let is_along = match self {
            Self::Locked | Self::Standing | Self::HotStanding | Self::Charging => true,
            Self::Turning => rims[0] < -TURNS_M_PER_S && rims[1] > TURNS_M_PER_S,
            _ => rims.iter().all(|rim| *rim > TURNS_M_PER_S),
        };
        if !is_along {
            return Err(TestbedError::OperatingState("its wheels turn another way"));
        }
        let cleaners = [
            MotorOutput::BrushMain,
            MotorOutput::BrushSides,
            MotorOutput::Vacuum,
        ];
        let cleans = matches!(self, Self::Cleaning | Self::WarmCleaning);
        if cleans && !cleaners.into_iter().all(|motor| robot.duty(motor) > 0.0) {
            return Err(TestbedError::OperatingState(
                "a brush or the suction does not run forward",
            ));
        }
        Ok(())
    }
}

fn arm(testbed: &mut Testbed) {
    testbed.arm();
    testbed.run(100);
}

/// The pack shows this temperature from now on.
pub(crate) fn show_temperature(testbed: &mut Testbed, temperature_dc: i32) {
    let shown = SensorFault::StuckAt(temperature_dc);
    testbed
        .robot_mut()
        .world_mut()
        .set_fault(SensorId::BatteryTemperature, Some(shown));
}

fn put_on_dock(testbed: &mut Testbed, seed: u64) {
    let mut random = Pcg::new(seed, PACKS);
    let make = PackMake::sound(&mut random);
    let (left, ambient_c) = (0.2 + 0.4 * random.unit(), 15.0 + 10.0 * random.unit());
    let world = testbed.robot_mut().world_mut();
    let dock = world.home().start();
    world.put_down_at(dock);
    world.set_pack(Pack::new(make, left, ambient_c));
}

/// Current that tells that the pack is being charged, ampere.
const CHARGING_A: f64 = 0.1;

fn wait_for_charge(testbed: &mut Testbed) -> Result<(), TestbedError> {
    let begun = (0..BEGINS_MS).any(|_| {
        testbed.tick();
        testbed.robot().world().truth().battery_a > CHARGING_A
    });
    if !begun {
        return Err(TestbedError::OperatingState("it does not charge"));
    }
    Ok(())
}

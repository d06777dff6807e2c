//! Switches: bumper, wheel drops, dust box, buttons, adapter.
//!
//! The home sets their states once a millisecond. A test may *force* a state instead, at any cycle, to measure the
//! firmware's reaction time; and every change may *bounce*, as contacts do.

use home::{Pcg, Sensors};

use super::encoder::ScheduledEdge;
use super::wiring::{DigitalLine, Wiring};
use super::{CYCLES_PER_MS, CYCLES_PER_S};

/// A switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Contact {
    /// Left half of the bumper.
    BumperLeft,
    /// Right half of the bumper.
    BumperRight,
    /// Left wheel hangs.
    WheelDropLeft,
    /// Right wheel hangs.
    WheelDropRight,
    /// The dust box is in.
    DustBox,
    /// A button is down (the ladder shows which one).
    AnyButton,
    /// The dock's contacts, or an adapter, carry voltage.
    Adapter,
}

impl Contact {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::BumperLeft,
        Self::BumperRight,
        Self::WheelDropLeft,
        Self::WheelDropRight,
        Self::DustBox,
        Self::AnyButton,
        Self::Adapter,
    ];

    fn line(self, wiring: &Wiring) -> DigitalLine {
        match self {
            Self::BumperLeft => wiring.bumpers[0],
            Self::BumperRight => wiring.bumpers[1],
            Self::WheelDropLeft => wiring.wheel_drops[0],
            Self::WheelDropRight => wiring.wheel_drops[1],
            Self::DustBox => wiring.dust_box,
            Self::AnyButton => wiring.button_any,
            Self::Adapter => wiring.adapter,
        }
    }

    const fn in_home(self, sensors: &Sensors) -> bool {
        match self {
            Self::BumperLeft => sensors.bumper_left,
            Self::BumperRight => sensors.bumper_right,
            Self::WheelDropLeft => sensors.wheel_drop_left,
            Self::WheelDropRight => sensors.wheel_drop_right,
            Self::DustBox => sensors.dust_box,
            Self::AnyButton => sensors.buttons != 0,
            Self::Adapter => sensors.dock_contacts,
        }
    }
}

/// Source of a switch's state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// The home.
    Home,
    /// It is held closed (pressed, in, powered).
    On,
    /// It is held open.
    Off,
}

/// From a cycle on, the caller sets the state of a switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct ContactOverride {
    cycle: u64,
    contact: Contact,
    hold: Hold,
}

/// All switches.
#[derive(Clone, Debug)]
pub(super) struct Contacts {
    lines: [DigitalLine; Contact::ALL.len()],
    on: [bool; Contact::ALL.len()],
    /// How they stood at the beginning of the millisecond.
    before: [bool; Contact::ALL.len()],
    holds: [Hold; Contact::ALL.len()],
    plans: Vec<ContactOverride>,
    bounce_cycles: u64,
    random: Pcg,
}

const STREAM: u64 = 0xB0CE;
/// Most times that a contact opens again after it closed, or the other way round.
const BOUNCES_MAX: u32 = 4;

impl Contacts {
    /// All off. After a change contacts bounce for up to `bounce_us` microseconds.
    pub(super) fn new(wiring: &Wiring, bounce_us: u32, seed: u64) -> Self {
        Self {
            lines: Contact::ALL.map(|contact| contact.line(wiring)),
            on: [false; Contact::ALL.len()],
            before: [false; Contact::ALL.len()],
            holds: [Hold::Home; Contact::ALL.len()],
            plans: Vec::new(),
            bounce_cycles: u64::from(bounce_us) * (CYCLES_PER_S / 1_000_000),
            random: Pcg::new(seed, STREAM),
        }
    }

    /// The levels now, as edges at `cycle`.
    pub(super) fn levels(&self, cycle: u64) -> [ScheduledEdge; Contact::ALL.len()] {
        Contact::ALL.map(|contact| {
            let line = self.lines[contact as usize];
            (cycle, line.pin, line.level(self.on[contact as usize]))
        })
    }

    /// The caller sets the state of the switch, from this cycle on.
    pub(super) fn plan(&mut self, contact: Contact, hold: Hold, cycle: u64) {
        self.plans.push(ContactOverride { cycle, contact, hold });
    }

    /// Whether the switch is on, bounces left out.
    pub(super) const fn is_on(&self, contact: Contact) -> bool {
        self.on[contact as usize]
    }

    /// Whether the switch was on at the beginning of the present millisecond.
    pub(super) const fn was_on(&self, contact: Contact) -> bool {
        self.before[contact as usize]
    }

    /// Edges of the millisecond that begins at `from`.
    pub(super) fn pass_ms(&mut self, from: u64, sensors: &Sensors, edges: &mut Vec<ScheduledEdge>) {
        for contact in Contact::ALL {
            let on = self.wanted(contact, sensors);
            self.switch(contact, (on, from), edges);
        }
        self.before = self.on;
        if self.plans.is_empty() {
            return;
        }
        let end = from + CYCLES_PER_MS;
        let (mut due, later): (Vec<_>, Vec<_>) = self.plans.drain(..).partition(|plan| plan.cycle < end);
        self.plans = later;
        due.sort_by_key(|plan| plan.cycle);
        for plan in due {
            self.holds[plan.contact as usize] = plan.hold;
            let on = self.wanted(plan.contact, sensors);
            self.switch(plan.contact, (on, plan.cycle.max(from)), edges);
        }
    }

    const fn wanted(&self, contact: Contact, sensors: &Sensors) -> bool {
        match self.holds[contact as usize] {
            Hold::Home => contact.in_home(sensors),
            Hold::On => true,
            Hold::Off => false,
        }
    }

    fn switch(&mut self, contact: Contact, (on, cycle): (bool, u64), edges: &mut Vec<ScheduledEdge>) {
        let place = contact as usize;
        if on == self.on[place] {
            return;
        }
        self.on[place] = on;
        let line = self.lines[place];
        edges.push((cycle, line.pin, line.level(on)));
        if self.bounce_cycles == 0 {
            return;
        }
        let mut moments: Vec<u64> = (0..2 * self.random.below(BOUNCES_MAX + 1))
            .map(|_| cycle + 1 + (self.random.unit() * self.bounce_cycles as f64) as u64)
            .collect();
        moments.sort_unstable();
        for (number, moment) in moments.into_iter().enumerate() {
            edges.push((moment, line.pin, line.level(on == (number % 2 == 1))));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Contact, Contacts, Hold};
    use crate::board::CYCLES_PER_MS;
    use crate::board::pinout::Pinout;
    use crate::board::wiring::Wiring;
    use home::Sensors;

    fn wiring() -> Wiring {
        Wiring::of(&Pinout::sr8730().unwrap()).unwrap()
    }

    #[test]
    fn the_home_switches_once_and_only_on_change() {
        let mut contacts = Contacts::new(&wiring(), 0, 1);
        let mut edges = Vec::new();
        let sensors = Sensors {
            bumper_left: true,
            ..Sensors::default()
        };
        for ms in 0..5 {
            contacts.pass_ms(ms * CYCLES_PER_MS, &sensors, &mut edges);
        }
        let line = wiring().bumpers[0];
        assert_eq!(edges, [(0, line.pin, line.level(true))]);
        assert!(contacts.is_on(Contact::BumperLeft));
    }

    #[test]
    fn a_press_comes_at_its_cycle_and_holds_against_the_home() {
        let mut contacts = Contacts::new(&wiring(), 0, 1);
        let (mut edges, sensors) = (Vec::new(), Sensors::default());
        contacts.plan(Contact::WheelDropRight, Hold::On, 100_007);
        contacts.plan(Contact::WheelDropRight, Hold::Home, 250_000);
        for ms in 0..5 {
            contacts.pass_ms(ms * CYCLES_PER_MS, &sensors, &mut edges);
        }
        let cycles: Vec<u64> = edges.iter().map(|(cycle, ..)| *cycle).collect();
        assert_eq!(cycles, [100_007, 250_000]);
    }

    #[test]
    fn a_bouncing_contact_ends_where_it_should() {
        let line = wiring().dust_box;
        let mut bounced = 0;
        for seed in 0..20 {
            let mut contacts = Contacts::new(&wiring(), 2_000, seed);
            let mut edges = Vec::new();
            let sensors = Sensors {
                dust_box: true,
                ..Sensors::default()
            };
            contacts.pass_ms(0, &sensors, &mut edges);
            assert_eq!(edges.last().map(|(_, _, level)| *level), Some(line.level(true)));
            assert!(edges.iter().all(|(cycle, ..)| *cycle <= 160_001));
            bounced += edges.len() - 1;
        }
        assert!(bounced > 20);
    }
}

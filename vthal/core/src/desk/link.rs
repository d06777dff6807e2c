//! The robot on the serial device: bytes to and from it, what it told last, and how good the link is.

use rvac_api::{DeviceTable, LinkReading, LogLevel, Topic, Update, Versions};
use rvac_protocol::message::{Command, Info, Inhibit, RobotHello, State};
use rvac_protocol::quality::Verdict;

use super::audience::Teller;
use super::driver::Brakes;
use super::journal::Part;
use super::link_facts::{Greeting, LinkFacts};

use crate::device::{Description, Device, DeviceCommand, DeviceIo, FirmwareEvent};
use crate::observe::{LinkView, currents_a};
use crate::refusal::Refused;
use crate::tap::Tap;
use crate::{LinkLoss, Record, to_api};

/// The link and the robot at its other end.
#[derive(Debug, Default)]
pub(crate) struct LinkDesk {
    /// The robot's link, while it is open.
    device: Option<Device>,
    facts: LinkFacts,
    tap: Tap,
    events: Vec<FirmwareEvent>,
}

impl LinkDesk {
    pub(crate) fn opened(&mut self, teller: &mut Teller<'_>) {
        self.device = Some(Device::new(teller.now_us));
        self.facts.opened(teller.now_us);
        self.tap = Tap::default();
        teller.log(LogLevel::Info, Part::Link, "serial device open".to_owned());
    }

    pub(crate) fn closed(&mut self, reason: &LinkLoss, teller: &mut Teller<'_>) {
        self.device = None;
        self.facts.closed();
        let text = match reason {
            LinkLoss::HungUp => "serial device lost: the other end hung up; waiting for it".to_owned(),
            LinkLoss::Failed(error) => format!("serial device lost: {error}; waiting for it"),
        };
        teller.log(LogLevel::Warn, Part::Link, text);
    }

    /// Takes bytes from the robot; gives what it told.
    pub(crate) fn receive(&mut self, bytes: &[u8], teller: &mut Teller<'_>) -> Vec<FirmwareEvent> {
        self.facts.count_in(bytes.len());
        self.tap_received(bytes, teller);
        let mut events = core::mem::take(&mut self.events);
        if let Some(device) = &mut self.device {
            let mut io = DeviceIo {
                now_us: teller.now_us,
                link: &mut teller.outputs.link,
                events: &mut events,
            };
            device.receive(bytes, &mut io);
        }
        events
    }

    /// Lets time pass; gives what the robot told.
    pub(crate) fn pass_time(&mut self, teller: &mut Teller<'_>) -> Vec<FirmwareEvent> {
        self.facts.pass_time(teller.now_us);
        let mut events = core::mem::take(&mut self.events);
        if let Some(device) = &mut self.device
            && teller.now_us >= device.next_wake_us()
        {
            let mut io = DeviceIo {
                now_us: teller.now_us,
                link: &mut teller.outputs.link,
                events: &mut events,
            };
            device.poll(&mut io);
        }
        events
    }

    /// Takes the list of events back, so that the next ones cost no memory of their own.
    pub(crate) fn reuse(&mut self, events: Vec<FirmwareEvent>) {
        self.events = events;
    }

    /// Tells the robot something. A new reason why it cannot be told goes to the log.
    pub(crate) fn command(&mut self, command: DeviceCommand, teller: &mut Teller<'_>) {
        let Some(device) = &mut self.device else { return };
        let mut io = DeviceIo {
            now_us: teller.now_us,
            link: &mut teller.outputs.link,
            events: &mut self.events,
        };
        if let Err(error) = device.command(command, &mut io)
            && self.facts.is_new_error(error)
        {
            let text = format!("{command:?} was not sent: {error}");
            teller.log(LogLevel::Debug, Part::Link, text);
        }
    }

    /// Sends a command of the wire as it is. For experts.
    ///
    /// # Errors
    /// Nothing was sent.
    pub(crate) fn send_raw(&mut self, command: Command, teller: &mut Teller<'_>) -> Result<(), Refused> {
        let device = self.device.as_mut().ok_or("no-robot")?;
        let mut io = DeviceIo {
            now_us: teller.now_us,
            link: &mut teller.outputs.link,
            events: &mut self.events,
        };
        device.send_raw(command, &mut io).map_err(|_| "not-sent")
    }

    pub(crate) fn next_wake_us(&self) -> Option<u64> {
        self.device.as_ref().map(Device::next_wake_us)
    }

    /// Whether a robot is there that takes commands.
    pub(crate) fn is_attached(&self) -> bool {
        self.device.as_ref().is_some_and(Device::is_attached)
    }

    /// Whether nothing moves as far as the newest reports tell, or nothing is known because no robot is there.
    pub(crate) fn stands_still(&self) -> bool {
        !self.is_attached() || self.facts.still_reports() > 0
    }

    /// Only reports from now on count for [`Self::stands_still`].
    pub(crate) fn forget_stillness(&mut self) {
        self.facts.forget_stillness();
    }

    pub(crate) fn greeted(&mut self, hello: &RobotHello) -> Greeting {
        self.facts.greeted(hello)
    }

    pub(crate) fn take_state(&mut self, now_us: u64, state: &State) {
        self.facts.take_state(now_us, state);
    }

    pub(crate) fn take_info(&mut self, info: Info) {
        self.facts.info = Some(info);
    }

    /// What the robot is, once it has told.
    pub(crate) fn description(&self) -> Option<&Description> {
        self.device.as_ref().and_then(Device::description)
    }

    /// The newest report.
    pub(crate) fn state(&self) -> Option<&State> {
        self.facts.state.as_ref()
    }

    /// Counts per second of the left and the right wheel.
    pub(crate) fn count_rates_hz(&self) -> [f64; 2] {
        self.facts.count_rates_hz
    }

    /// What the motors draw, of a robot that measures it.
    pub(crate) fn currents_a(&self) -> Option<[f32; 3]> {
        currents_a(self.state()?, self.description()?)
    }

    /// Whether the robot has heard of the last stop.
    pub(crate) fn brakes(&self) -> Brakes {
        let knows = self
            .state()
            .is_some_and(|state| state.inhibits.contains(Inhibit::Stopped));
        if self.device.as_ref().is_some_and(Device::is_latched) && !knows {
            Brakes::Braking
        } else {
            Brakes::Free
        }
    }

    /// How the brain sees the link.
    pub(crate) fn view(&self, now_us: u64) -> LinkView {
        let up = self.is_attached() && self.facts.is_fresh(now_us);
        let verdict = self
            .device
            .as_ref()
            .map(|device| device.quality().verdict)
            .unwrap_or_default();
        let speed_share = match verdict {
            Verdict::Good => 1.0,
            Verdict::Poor => 0.5,
            Verdict::Bad => 0.0,
        };
        LinkView { up, speed_share }
    }

    /// Versions of all that is at work, with a daemon of this one.
    pub(crate) fn versions(&self, daemon: &str) -> Versions {
        let description = self.description();
        let info = self.facts.info.as_ref();
        Versions {
            vthal: daemon.to_owned(),
            brain: daemon.to_owned(),
            firmware: description.map(|robot| robot.identity.firmware.clone()),
            cordlib: info.map(|info| info.cordlib_version.as_str().to_owned()),
            protocol: description.map(|robot| robot.identity.protocol),
        }
    }

    /// What clients are told of the robot's parts.
    pub(crate) fn table(&self, now_us: u64, daemon: &str) -> DeviceTable {
        let (bytes_in_per_s, bytes_out_per_s) = self.facts.bytes_per_s();
        let info = self.facts.info.as_ref();
        let mut table = DeviceTable {
            versions: self.versions(daemon),
            battery: info.and_then(|info| info.battery.as_ref()).map(to_api::battery),
            main_loop_hz: info.map(|info| info.main_steps_hz),
            bytes_out_per_s,
            bytes_in_per_s,
            link: self.reading(now_us),
            ..DeviceTable::default()
        };
        if let (Some(state), Some(description)) = (self.state(), self.description()) {
            fill_from_state(&mut table, state, description);
            let [left, right] = self.facts.count_rates_hz;
            table.wheel_left_m_per_s = left * description.count_m;
            table.wheel_right_m_per_s = right * description.count_m;
        }
        table
    }

    fn reading(&self, now_us: u64) -> LinkReading {
        let quality = self.device.as_ref().map(Device::quality).unwrap_or_default();
        LinkReading {
            up: self.view(now_us).up,
            age_ms: self.facts.age_ms(now_us).unwrap_or(u32::MAX),
            bad_share: f64::from(quality.bad) / f64::from(quality.packets.max(1)),
            round_trip_ms: quality.round_trip_ms.map(f64::from),
            resets: self.facts.resets(),
            reset_cause: self.facts.reset_cause().map(|cause| cause.name().to_owned()),
            reconnects: self.facts.reconnects(),
            binary: self.device.as_ref().is_some_and(Device::is_binary),
        }
    }

    fn session_number(&self) -> u16 {
        self.device.as_ref().map_or(0, Device::session_number)
    }

    fn tap_received(&mut self, bytes: &[u8], teller: &mut Teller<'_>) {
        if wants_packets(teller) {
            let session = self.session_number();
            let mut packets = core::mem::take(&mut self.tap.packets);
            self.tap.take_received(session, bytes, &mut packets);
            tell_packets(&mut packets, teller);
            self.tap.packets = packets;
        }
    }

    /// Shows what was sent since the link's output was this long.
    pub(crate) fn tap_sent(&mut self, link_before: usize, teller: &mut Teller<'_>) {
        let sent = teller.outputs.link.len() - link_before;
        if sent == 0 {
            return;
        }
        self.facts.count_out(sent);
        if wants_packets(teller) {
            let session = self.session_number();
            let mut packets = core::mem::take(&mut self.tap.packets);
            let bytes = teller.outputs.link.get(link_before..).unwrap_or_default();
            self.tap.take_sent(session, bytes, &mut packets);
            tell_packets(&mut packets, teller);
            self.tap.packets = packets;
        }
    }
}

fn wants_packets(teller: &Teller<'_>) -> bool {
    teller.records_run() || teller.has_followers(Topic::Packets)
}

fn tell_packets(packets: &mut Vec<(crate::Direction, String)>, teller: &mut Teller<'_>) {
    let time_us = teller.now_us;
    let is_followed = teller.has_followers(Topic::Packets);
    for (direction, text) in packets.drain(..) {
        teller.record(|| Record::Packet {
            time_us,
            direction,
            text: text.clone(),
        });
        if is_followed {
            let update = Update::Packet {
                t: to_api::seconds(time_us),
                direction: direction.symbol(),
                text,
            };
            teller.tell(Topic::Packets, update);
        }
    }
}

fn fill_from_state(table: &mut DeviceTable, state: &State, description: &Description) {
    table.bumpers = [state.bumpers.left, state.bumpers.right];
    table.cliffs = [state.cliffs.left, state.cliffs.middle, state.cliffs.right];
    table.wheel_drops = [state.wheel_drops.left, state.wheel_drops.right];
    table.proximity = state
        .proximity
        .iter()
        .take(usize::from(description.sensors.proximity))
        .map(|raw| f32::from(*raw) / 255.0)
        .collect();
    table.currents_a = currents_a(state, description);
    table.cleaners = [0, 1, 2].map(|bit| state.cleaners & 1 << bit != 0);
    table.dust_box = state.dust_box;
    table.docked = state.docked;
}

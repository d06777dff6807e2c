//! Who may command (S27) and for how long (S23).
//!
//! Priority: safety, then the buttons on the robot, then the person who drives, then schedules. *Seat*: the one place from
//! which somebody drives by hand; its holder keeps it as long as the lease is renewed. *Centring*: a stick that
//! was held while its lease ended or while somebody else stopped the robot must return to the centre first, so that the
//! robot never starts from a touch of long ago.

use std::collections::BTreeSet;

use crate::ClientId;

/// Longest lease of the seat in microseconds (S23).
pub(crate) const LEASE_MAX_US: u64 = 400_000;

/// A position of the stick, with its lease.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stick {
    /// Forward speed, m/s.
    pub(crate) speed_m_per_s: f64,
    /// Turn rate, rad/s.
    pub(crate) turn_rad_per_s: f64,
    /// Lease in microseconds.
    pub(crate) lease_us: u64,
}

impl Stick {
    fn is_centred(&self) -> bool {
        self.speed_m_per_s == 0.0 && self.turn_rad_per_s == 0.0
    }
}

/// Why a client may not command now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Denied {
    /// Somebody else sits in the driver's seat.
    DriverBusy(ClientId),
    /// The stick must return to the centre first.
    ReturnToCentre,
    /// The lease is 0 or longer than [`LEASE_MAX_US`].
    LeaseRange,
}

/// Who asks for a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// A button on the robot.
    Button,
    /// A person at a client.
    Person(ClientId),
    /// A schedule: everybody else comes first.
    Schedule,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Seat {
    client: ClientId,
    until_us: u64,
}

/// The arbiter between all who command.
#[derive(Clone, Debug, Default)]
pub(crate) struct Arbiter {
    seat: Option<Seat>,
    centring: BTreeSet<ClientId>,
}

impl Arbiter {
    /// Who drives.
    #[must_use]
    pub(crate) fn driver(&self) -> Option<ClientId> {
        self.seat.map(|seat| seat.client)
    }

    /// When the lease of the seat ends.
    #[must_use]
    pub(crate) fn lease_end_us(&self) -> Option<u64> {
        self.seat.map(|seat| seat.until_us)
    }

    /// A client moves the stick: it takes or keeps the seat. Gives the end of the lease.
    ///
    /// # Errors
    /// Why it may not.
    pub(crate) fn drive(&mut self, now_us: u64, client: ClientId, stick: Stick) -> Result<u64, Denied> {
        if stick.lease_us == 0 || stick.lease_us > LEASE_MAX_US {
            return Err(Denied::LeaseRange);
        }
        self.expire(now_us);
        if let Some(seat) = self.seat
            && seat.client != client
        {
            return Err(Denied::DriverBusy(seat.client));
        }
        if stick.is_centred() {
            self.centring.remove(&client);
        } else if self.centring.contains(&client) {
            return Err(Denied::ReturnToCentre);
        }
        let until_us = now_us + stick.lease_us;
        self.seat = Some(Seat { client, until_us });
        Ok(until_us)
    }

    /// Whether `source` may start or change a job now.
    ///
    /// # Errors
    /// [`Denied::DriverBusy`] while somebody else drives; buttons on the robot come before that.
    pub(crate) fn admit(&mut self, now_us: u64, source: Source) -> Result<(), Denied> {
        self.expire(now_us);
        self.admit_now(source)
    }

    /// As [`Self::admit`], while no lease has ended unseen.
    pub(crate) fn admit_now(&self, source: Source) -> Result<(), Denied> {
        match (self.seat, source) {
            (Some(seat), Source::Person(client)) if seat.client != client => {
                Err(Denied::DriverBusy(seat.client))
            }
            (Some(seat), Source::Schedule) => Err(Denied::DriverBusy(seat.client)),
            _ => Ok(()),
        }
    }

    /// Empties the seat if its lease is over; gives the one who sat there.
    pub(crate) fn expire(&mut self, now_us: u64) -> Option<ClientId> {
        let seat = self.seat.filter(|seat| now_us >= seat.until_us)?;
        self.seat = None;
        self.centring.insert(seat.client);
        Some(seat.client)
    }

    /// The driver leaves by itself. Whether it was the driver.
    pub(crate) fn release(&mut self, client: ClientId) -> bool {
        let was_driver = self.driver() == Some(client);
        if was_driver {
            self.seat = None;
        }
        was_driver
    }

    /// Something of higher priority stops the robot: the driver leaves and must centre the stick.
    pub(crate) fn preempt(&mut self) {
        if let Some(seat) = self.seat.take() {
            self.centring.insert(seat.client);
        }
    }

    /// A client is gone for ever. Whether it was the driver.
    pub(crate) fn forget(&mut self, client: ClientId) -> bool {
        self.centring.remove(&client);
        self.release(client)
    }
}

#[cfg(test)]
mod tests {
    use super::{Arbiter, Denied, Source, Stick};
    use crate::ClientId;

    const ANNA: ClientId = ClientId(1);
    const BERT: ClientId = ClientId(2);
    const FORWARD: Stick = Stick {
        speed_m_per_s: 0.2,
        turn_rad_per_s: 0.0,
        lease_us: 400_000,
    };
    const CENTRE: Stick = Stick {
        speed_m_per_s: 0.0,
        ..FORWARD
    };

    #[test]
    fn one_seat_and_no_take_over() {
        let mut arbiter = Arbiter::default();
        assert_eq!(arbiter.drive(0, ANNA, FORWARD), Ok(400_000));
        assert_eq!(arbiter.drive(1, BERT, FORWARD), Err(Denied::DriverBusy(ANNA)));
        assert_eq!(
            arbiter.admit(1, Source::Person(BERT)),
            Err(Denied::DriverBusy(ANNA))
        );
        assert_eq!(arbiter.admit(1, Source::Person(ANNA)), Ok(()));
        assert_eq!(arbiter.admit(1, Source::Button), Ok(()));
        assert_eq!(
            arbiter.admit(1, Source::Schedule),
            Err(Denied::DriverBusy(ANNA)),
            "a schedule never takes the robot from anybody"
        );
        assert!(!arbiter.release(BERT) && arbiter.release(ANNA));
        assert_eq!(arbiter.drive(2, BERT, FORWARD), Ok(400_002));
    }

    #[test]
    fn a_lease_that_ended_wants_the_stick_centred() {
        let mut arbiter = Arbiter::default();
        arbiter.drive(0, ANNA, FORWARD).expect("free");
        assert_eq!(arbiter.expire(399_999), None);
        assert_eq!(arbiter.expire(400_000), Some(ANNA));
        assert_eq!(arbiter.drive(400_001, ANNA, FORWARD), Err(Denied::ReturnToCentre));
        assert_eq!(arbiter.driver(), None, "a refused driver does not sit");
        arbiter.drive(400_002, ANNA, CENTRE).expect("centred");
        arbiter.drive(400_003, ANNA, FORWARD).expect("armed again");
    }

    #[test]
    fn whoever_is_preempted_must_centre() {
        let mut arbiter = Arbiter::default();
        arbiter.drive(0, ANNA, FORWARD).expect("free");
        arbiter.preempt();
        assert_eq!(arbiter.driver(), None);
        assert_eq!(arbiter.drive(1, ANNA, FORWARD), Err(Denied::ReturnToCentre));
        assert_eq!(arbiter.drive(1, BERT, FORWARD), Ok(400_001));
    }

    #[test]
    fn leases_beyond_the_limit_are_refused() {
        let mut arbiter = Arbiter::default();
        for lease_us in [0, 400_001] {
            assert_eq!(
                arbiter.drive(0, ANNA, Stick { lease_us, ..FORWARD }),
                Err(Denied::LeaseRange)
            );
        }
    }
}

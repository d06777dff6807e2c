//! Who may command (S27) and for how long (S23).
//!
//! Priority: safety, then the buttons on the robot, then the person who drives, then schedules. *Seat*: the one place from
//! which somebody drives by hand; its holder keeps it as long as the lease is renewed. Only a stick in its centre takes the
//! empty seat, whoever moves it and however the seat became empty. A stick that is still held over a connection that broke, a
//! lease that ended, a stop, or a restart of the daemon therefore moves nothing.

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
    /// The seat is empty, and only a stick in its centre takes it.
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
        match self.seat {
            Some(seat) if seat.client != client => return Err(Denied::DriverBusy(seat.client)),
            None if !stick.is_centred() => return Err(Denied::ReturnToCentre),
            _ => {}
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
        Some(seat.client)
    }

    /// A client lets go of the stick, or is gone. Whether it was the driver.
    pub(crate) fn release(&mut self, client: ClientId) -> bool {
        let was_driver = self.driver() == Some(client);
        if was_driver {
            self.seat = None;
        }
        was_driver
    }

    /// Something of higher priority stops the robot: the driver leaves.
    pub(crate) fn preempt(&mut self) {
        self.seat = None;
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

    /// Somebody sits who took the seat in the centre.
    fn with_anna() -> Arbiter {
        let mut arbiter = Arbiter::default();
        arbiter.drive(0, ANNA, CENTRE).expect("free");
        arbiter.drive(0, ANNA, FORWARD).expect("hers");
        arbiter
    }

    #[test]
    fn one_seat_and_no_take_over() {
        let mut arbiter = with_anna();
        assert_eq!(arbiter.drive(1, BERT, FORWARD), Err(Denied::DriverBusy(ANNA)));
        assert_eq!(arbiter.drive(1, BERT, CENTRE), Err(Denied::DriverBusy(ANNA)));
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
        assert_eq!(arbiter.drive(2, BERT, CENTRE), Ok(400_002));
    }

    #[test]
    fn only_a_stick_in_its_centre_takes_the_empty_seat_however_it_became_empty() {
        type Empties = fn(&mut Arbiter);
        let ends: [(&str, Empties); 4] = [
            ("nobody ever drove", |arbiter| *arbiter = Arbiter::default()),
            ("silence", |arbiter| {
                assert_eq!(arbiter.expire(399_999), None);
                assert_eq!(arbiter.expire(400_000), Some(ANNA));
            }),
            ("let go, or gone", |arbiter| assert!(arbiter.release(ANNA))),
            ("a stop", Arbiter::preempt),
        ];
        for (end, empty) in ends {
            for client in [ANNA, BERT] {
                let mut arbiter = with_anna();
                empty(&mut arbiter);
                for _ in 0..3 {
                    let refused = arbiter.drive(400_001, client, FORWARD);
                    assert_eq!(refused, Err(Denied::ReturnToCentre), "{end}, {client:?}");
                    assert_eq!(arbiter.driver(), None, "a refused driver does not sit");
                }
                arbiter.drive(400_002, client, CENTRE).expect("centred");
                arbiter.drive(400_003, client, FORWARD).expect("and then off");
            }
        }
    }

    /// The lease ends unseen: no wake came between it and the next word of the same client.
    #[test]
    fn a_lease_that_ended_unseen_has_ended() {
        let mut arbiter = with_anna();
        assert_eq!(arbiter.drive(400_000, ANNA, FORWARD), Err(Denied::ReturnToCentre));
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

//! How many connections there are, in all and from one address, so that no single one takes them all, and who leaves for whom.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tokio::sync::Notify;

/// Connections at one time; a page needs two.
const ALL_MAX: usize = 128;

/// Connections of one address at one time. All pages on the robot's own computer count as one.
const OF_ONE_MAX: usize = 32;

/// The connections of the moment.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seats(Arc<Mutex<Table>>);

#[derive(Debug, Default)]
struct Table {
    /// Number of the next one: they rise, so the lowest is the oldest.
    next: u64,
    taken: BTreeMap<u64, Taken>,
}

#[derive(Debug)]
struct Taken {
    address: IpAddr,
    /// A paired device has shown itself on it.
    is_known: bool,
    parting: Arc<Notify>,
}

/// Why there is no seat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoSeat {
    /// Paired devices of the address have its share.
    OfOneAddress,
    /// Paired devices have all of them.
    Full,
}

/// Counts as one connection as long as it lives.
#[derive(Debug)]
pub(crate) struct Seat {
    number: u64,
    seats: Seats,
    parting: Arc<Notify>,
}

/// Tells whose a connection is.
#[derive(Clone, Debug)]
pub(crate) struct SeatMark {
    number: u64,
    seats: Seats,
}

impl Seats {
    /// A seat for a connection from `address`. Where there is none left a stranger parts: a device that is paired, and pressed Stop, must
    /// not wait for connections of which nothing is known. It is the oldest of the address that has most strangers: a paired device is a
    /// stranger, too, until its handshake is over, and those who come in crowds shall only push out each other.
    pub(crate) fn take(&self, address: IpAddr) -> Result<Seat, NoSeat> {
        let mut table = self.table();
        let of_address = table.taken.values().filter(|taken| taken.address == address);
        if of_address.count() >= OF_ONE_MAX {
            table
                .part_for_one_more(Some(address))
                .ok_or(NoSeat::OfOneAddress)?;
        } else if table.taken.len() >= ALL_MAX {
            table.part_for_one_more(None).ok_or(NoSeat::Full)?;
        }
        let number = table.next;
        table.next += 1;
        let parting = Arc::new(Notify::new());
        let taken = Taken {
            address,
            is_known: false,
            parting: Arc::clone(&parting),
        };
        table.taken.insert(number, taken);
        Ok(Seat {
            number,
            seats: self.clone(),
            parting,
        })
    }

    #[cfg(test)]
    pub(crate) fn count(&self) -> usize {
        self.table().taken.len()
    }

    fn table(&self) -> MutexGuard<'_, Table> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Table {
    /// The oldest stranger of `address` parts, or of the address that has most of them; none where everybody is known.
    fn part_for_one_more(&mut self, address: Option<IpAddr>) -> Option<()> {
        let mut strangers: BTreeMap<IpAddr, (usize, u64)> = BTreeMap::new();
        let unknown = self.taken.iter().filter(|(_, taken)| !taken.is_known);
        for (number, taken) in unknown {
            strangers.entry(taken.address).or_insert((0, *number)).0 += 1;
        }
        let (_, number) = match address {
            Some(address) => strangers.get(&address).copied(),
            None => strangers
                .into_values()
                .max_by_key(|(count, oldest)| (*count, Reverse(*oldest))),
        }?;
        let stranger = self.taken.remove(&number)?;
        stranger.parting.notify_one();
        Some(())
    }
}

impl Seat {
    pub(crate) fn mark(&self) -> SeatMark {
        SeatMark {
            number: self.number,
            seats: self.seats.clone(),
        }
    }

    /// Comes when the connection must leave.
    pub(crate) async fn parting(&self) {
        self.parting.notified().await;
    }
}

impl SeatMark {
    /// The connection is that of somebody who may be here: it leaves for nobody.
    pub(crate) fn is_known(&self) {
        if let Some(taken) = self.seats.table().taken.get_mut(&self.number) {
            taken.is_known = true;
        }
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        self.seats.table().taken.remove(&self.number);
    }
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;
    use std::future::Future as _;
    use std::net::{IpAddr, Ipv4Addr};
    use std::pin::pin;
    use std::task::{Context, Waker};

    use super::{ALL_MAX, NoSeat, OF_ONE_MAX, Seat, Seats};

    fn address(last: u8) -> IpAddr {
        IpAddr::V4(Ipv4Addr::new(192, 168, 1, last))
    }

    fn must_part(seat: &Seat) -> bool {
        let mut parting = pin!(seat.parting());
        parting
            .as_mut()
            .poll(&mut Context::from_waker(Waker::noop()))
            .is_ready()
    }

    /// As many as there are, of as many addresses as that takes.
    fn all(seats: &Seats) -> Vec<Seat> {
        let addresses = (0..ALL_MAX).map(|place| address(u8::try_from(place / OF_ONE_MAX).unwrap()));
        addresses.map(|address| seats.take(address).unwrap()).collect()
    }

    #[test]
    fn one_address_takes_its_share_and_gives_it_back() {
        let seats = Seats::default();
        let mut taken: Vec<Seat> = (0..OF_ONE_MAX).map(|_| seats.take(address(2)).unwrap()).collect();
        taken.iter().for_each(|seat| seat.mark().is_known());
        assert_eq!(seats.take(address(2)).unwrap_err(), NoSeat::OfOneAddress);
        let other = seats.take(address(3)).unwrap();
        taken.pop();
        taken.push(seats.take(address(2)).unwrap());
        drop((taken, other));
        assert!(seats.table().taken.is_empty());
    }

    #[test]
    fn one_more_of_an_address_that_has_its_share_takes_the_place_of_its_oldest_stranger() {
        let seats = Seats::default();
        let taken: Vec<Seat> = (0..OF_ONE_MAX).map(|_| seats.take(address(2)).unwrap()).collect();
        taken[0].mark().is_known();
        let phone = seats.take(address(2)).unwrap();
        let parting: Vec<usize> = (0..OF_ONE_MAX)
            .filter(|place| must_part(&taken[*place]))
            .collect();
        assert_eq!(parting, [1]);
        assert!(!must_part(&phone));
        assert_eq!(seats.table().taken.len(), OF_ONE_MAX);
    }

    #[test]
    fn a_phone_in_its_handshake_keeps_its_seat_while_a_crowd_comes_without_end() {
        let seats = Seats::default();
        let mut crowd = VecDeque::from(all(&seats));
        let phone = seats.take(address(99)).unwrap();
        for place in 0..10 * ALL_MAX {
            let one_more = address(u8::try_from(place % 4).unwrap());
            crowd.push_back(seats.take(one_more).unwrap());
            if crowd.len() > ALL_MAX {
                crowd.pop_front();
            }
        }
        assert!(!must_part(&phone));
        assert!(seats.table().taken.contains_key(&phone.number));
    }

    #[test]
    fn the_oldest_stranger_parts_for_one_more_and_who_is_known_never_does() {
        let seats = Seats::default();
        let taken = all(&seats);
        taken[0].mark().is_known();
        let one_more = seats.take(address(99)).unwrap();
        let parting: Vec<usize> = (0..ALL_MAX).filter(|place| must_part(&taken[*place])).collect();
        assert_eq!(
            parting,
            [OF_ONE_MAX],
            "of an address that has its share of strangers"
        );
        for seat in taken.iter().chain([&one_more]) {
            seat.mark().is_known();
        }
        assert_eq!(seats.take(address(98)).unwrap_err(), NoSeat::Full);
        drop(taken);
        assert_eq!(seats.table().taken.len(), 1);
    }
}

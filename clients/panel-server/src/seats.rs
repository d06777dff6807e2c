//! How many connections there are, in all and from one address, so that no single one takes them all, and who leaves for whom.

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
    /// The address has its share.
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
    /// A seat for a connection from `address`. When all are taken the oldest stranger parts: a device that is paired, and pressed
    /// Stop, must not wait for connections of which nothing is known.
    pub(crate) fn take(&self, address: IpAddr) -> Result<Seat, NoSeat> {
        let mut table = self.table();
        let of_address = table.taken.values().filter(|taken| taken.address == address);
        if of_address.count() >= OF_ONE_MAX {
            return Err(NoSeat::OfOneAddress);
        }
        if table.taken.len() >= ALL_MAX {
            let mut taken = table.taken.iter();
            let stranger = taken.find(|(_, taken)| !taken.is_known);
            let number = *stranger.ok_or(NoSeat::Full)?.0;
            if let Some(stranger) = table.taken.remove(&number) {
                stranger.parting.notify_one();
            }
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

    fn table(&self) -> MutexGuard<'_, Table> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
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
        assert_eq!(seats.take(address(2)).unwrap_err(), NoSeat::OfOneAddress);
        let other = seats.take(address(3)).unwrap();
        taken.pop();
        taken.push(seats.take(address(2)).unwrap());
        drop((taken, other));
        assert!(seats.table().taken.is_empty());
    }

    #[test]
    fn the_oldest_stranger_parts_for_one_more_and_who_is_known_never_does() {
        let seats = Seats::default();
        let taken = all(&seats);
        taken[0].mark().is_known();
        let one_more = seats.take(address(99)).unwrap();
        let parting: Vec<usize> = (0..ALL_MAX).filter(|place| must_part(&taken[*place])).collect();
        assert_eq!(parting, [1]);
        for seat in taken.iter().chain([&one_more]) {
            seat.mark().is_known();
        }
        assert_eq!(seats.take(address(98)).unwrap_err(), NoSeat::Full);
        drop(taken);
        assert_eq!(seats.table().taken.len(), 1);
    }
}

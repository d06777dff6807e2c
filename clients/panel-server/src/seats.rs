//! How many connections there are, in all, from one address and of one paired device, so that no single one takes them all, and who leaves
//! for whom. A WebSocket keeps the seat of the connection that it was.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use pairing::TokenId;
use tokio::sync::watch;

/// Connections at one time; a page needs two.
const ALL_MAX: usize = 128;

/// Connections of one address at one time. All pages on the robot's own computer count as one.
const OF_ONE_MAX: usize = 32;

/// Connections of one paired device at one time: pages in several tabs, each with the few that a browser opens at once.
const OF_DEVICE_MAX: usize = 16;

/// Connections that no paired device loses for somebody else: those of one page.
const KEPT: usize = 2;

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
    holder: Holder,
    /// Says when the connection must leave.
    parting: watch::Sender<bool>,
}

/// Whose a connection is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Holder {
    /// Nothing is known of it yet.
    Stranger,
    /// Whoever is on the robot's own computer may be here.
    Local,
    /// A paired device has shown itself on it.
    Device(TokenId),
}

/// Why there is no seat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoSeat {
    /// Who may be here has the share of the address, and nobody more than a page needs.
    OfOneAddress,
    /// The same of all of them.
    Full,
}

/// Counts as one connection as long as it lives.
#[derive(Debug)]
pub(crate) struct Seat {
    number: u64,
    seats: Seats,
    parting: watch::Receiver<bool>,
}

impl Seats {
    /// A seat for a connection from `address`. Where there is none left a stranger parts: a device that is paired, and pressed Stop, must
    /// not wait for connections of which nothing is known. It is the oldest of the address that has most strangers: a paired device is a
    /// stranger, too, until its handshake is over, and those who come in crowds shall only push out each other. Where there is no stranger
    /// the device with most connections loses its oldest.
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
        let (parting, told) = watch::channel(false);
        let taken = Taken {
            address,
            holder: Holder::Stranger,
            parting,
        };
        table.taken.insert(number, taken);
        Ok(Seat {
            number,
            seats: self.clone(),
            parting: told,
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
    /// The oldest stranger of `address` parts, or of the address that has most of them; without strangers the oldest of the device with most
    /// connections there. None where nobody has more than is kept for each.
    fn part_for_one_more(&mut self, address: Option<IpAddr>) -> Option<()> {
        let mut strangers: BTreeMap<IpAddr, (usize, u64)> = BTreeMap::new();
        let mut devices: BTreeMap<TokenId, (usize, u64)> = BTreeMap::new();
        let asked = |taken: &Taken| address.is_none_or(|address| taken.address == address);
        for (number, taken) in self.taken.iter().filter(|(_, taken)| asked(taken)) {
            match taken.holder {
                Holder::Stranger => strangers.entry(taken.address).or_insert((0, *number)).0 += 1,
                Holder::Device(device) => devices.entry(device).or_insert((0, *number)).0 += 1,
                Holder::Local => {}
            }
        }
        let oldest_of_most = |counted: &mut dyn Iterator<Item = (usize, u64)>| {
            counted.max_by_key(|(count, oldest)| (*count, Reverse(*oldest)))
        };
        let stranger = oldest_of_most(&mut strangers.into_values());
        let known = || oldest_of_most(&mut devices.into_values().filter(|(count, _)| *count > KEPT));
        let (_, number) = stranger.or_else(known)?;
        self.part(number);
        Some(())
    }

    fn part(&mut self, number: u64) {
        if let Some(taken) = self.taken.remove(&number) {
            taken.parting.send_replace(true);
        }
    }
}

impl Seat {
    /// The connection is that of somebody who may be here. A device that has more than its share loses its oldest.
    pub(crate) fn belongs_to(&self, holder: Holder) {
        let mut table = self.seats.table();
        let Some(taken) = table.taken.get_mut(&self.number) else {
            return;
        };
        taken.holder = holder;
        if !matches!(holder, Holder::Device(_)) {
            return;
        }
        let own = table.taken.iter().filter(|(_, taken)| taken.holder == holder);
        let own: Vec<u64> = own.map(|(number, _)| *number).collect();
        let surplus = own.len().saturating_sub(OF_DEVICE_MAX);
        let older = own.into_iter().filter(|number| *number != self.number);
        older.take(surplus).for_each(|number| table.part(number));
    }

    /// Comes when the connection must leave.
    pub(crate) async fn parting(&self) {
        let mut parting = self.parting.clone();
        // Who was told to leave has no place in the table any more, and the word is the last one.
        while !*parting.borrow_and_update() {
            if parting.changed().await.is_err() {
                return;
            }
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

    use super::{ALL_MAX, Holder, KEPT, NoSeat, OF_DEVICE_MAX, OF_ONE_MAX, Seat, Seats};

    fn address(last: u8) -> IpAddr {
        IpAddr::V4(Ipv4Addr::new(192, 168, 1, last))
    }

    fn device(number: u8) -> Holder {
        Holder::Device(format!("{number:016x}").parse().unwrap())
    }

    /// Seats of an address that belong to a device.
    fn of_device(seats: &Seats, place: u8, count: usize) -> Vec<Seat> {
        let take = || {
            let seat = seats.take(address(place)).unwrap();
            seat.belongs_to(device(place));
            seat
        };
        std::iter::repeat_with(take).take(count).collect()
    }

    fn parting(taken: &[Seat]) -> Vec<usize> {
        (0..taken.len())
            .filter(|place| must_part(&taken[*place]))
            .collect()
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
        taken.iter().for_each(|seat| seat.belongs_to(Holder::Local));
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
        taken[0].belongs_to(Holder::Local);
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
        taken[0].belongs_to(Holder::Local);
        let one_more = seats.take(address(99)).unwrap();
        let parting: Vec<usize> = (0..ALL_MAX).filter(|place| must_part(&taken[*place])).collect();
        assert_eq!(
            parting,
            [OF_ONE_MAX],
            "of an address that has its share of strangers"
        );
        for seat in taken.iter().chain([&one_more]) {
            seat.belongs_to(Holder::Local);
        }
        assert_eq!(seats.take(address(98)).unwrap_err(), NoSeat::Full);
        drop(taken);
        assert_eq!(seats.table().taken.len(), 1);
    }

    #[test]
    fn a_device_that_takes_more_than_its_share_loses_its_oldest() {
        let seats = Seats::default();
        let other = of_device(&seats, 3, 1);
        let taken = of_device(&seats, 2, OF_DEVICE_MAX + 3);
        assert_eq!(parting(&taken), [0, 1, 2]);
        assert!(parting(&other).is_empty(), "another one keeps its own");
        taken[9].belongs_to(device(2));
        assert_eq!(parting(&taken), [0, 1, 2], "showing itself again takes no more");
        assert_eq!(seats.count(), OF_DEVICE_MAX + 1);
    }

    #[test]
    fn where_devices_have_all_seats_the_one_with_most_makes_room() {
        let seats = Seats::default();
        let pages: Vec<Vec<Seat>> = (100..104).map(|place| of_device(&seats, place, KEPT)).collect();
        let hostile: Vec<Vec<Seat>> = (0..8).map(|place| of_device(&seats, place, 15)).collect();
        assert_eq!(seats.count(), ALL_MAX);
        let phone = of_device(&seats, 99, 2);
        let lost: Vec<Vec<usize>> = hostile.iter().map(|taken| parting(taken)).collect();
        assert_eq!(lost.concat(), [0, 0], "the oldest of two of them");
        assert!(
            pages
                .iter()
                .chain([&phone])
                .all(|taken| parting(taken).is_empty())
        );
    }

    #[test]
    fn where_everybody_has_one_page_nobody_parts() {
        let seats = Seats::default();
        let count = u8::try_from(ALL_MAX / KEPT).unwrap();
        let pages: Vec<Vec<Seat>> = (0..count).map(|place| of_device(&seats, place, KEPT)).collect();
        assert_eq!(seats.take(address(99)).unwrap_err(), NoSeat::Full);
        assert!(pages.iter().all(|taken| parting(taken).is_empty()));
    }
}

//! How many connections there are, in all and from one address, so that no single one takes them all.

use std::collections::BTreeMap;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, PoisonError};

use tokio::sync::{OwnedSemaphorePermit, Semaphore};

/// Connections at one time; a page needs two.
const ALL_MAX: usize = 128;

/// Connections of one address at one time. All pages on the robot's own computer count as one.
const OF_ONE_MAX: usize = 32;

/// The connections of the moment.
#[derive(Clone, Debug)]
pub(crate) struct Seats {
    all: Arc<Semaphore>,
    by_address: Arc<Mutex<BTreeMap<IpAddr, usize>>>,
}

/// Counts as one connection as long as it lives.
#[derive(Debug)]
pub(crate) struct Seat {
    _one_of_all: OwnedSemaphorePermit,
    address: IpAddr,
    by_address: Arc<Mutex<BTreeMap<IpAddr, usize>>>,
}

impl Default for Seats {
    fn default() -> Self {
        Self {
            all: Arc::new(Semaphore::new(ALL_MAX)),
            by_address: Arc::default(),
        }
    }
}

impl Seats {
    /// Waits until there is room for one more connection.
    pub(crate) async fn room(&self) -> Option<OwnedSemaphorePermit> {
        Arc::clone(&self.all).acquire_owned().await.ok()
    }

    /// Takes it for a connection from `address`, unless that has too many.
    pub(crate) fn take(&self, room: OwnedSemaphorePermit, address: IpAddr) -> Option<Seat> {
        let mut counts = self.by_address.lock().unwrap_or_else(PoisonError::into_inner);
        let count = counts.entry(address).or_default();
        if *count >= OF_ONE_MAX {
            return None;
        }
        *count += 1;
        Some(Seat {
            _one_of_all: room,
            address,
            by_address: Arc::clone(&self.by_address),
        })
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        let mut counts = self.by_address.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(count) = counts.get_mut(&self.address) {
            *count -= 1;
            if *count == 0 {
                counts.remove(&self.address);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{ALL_MAX, OF_ONE_MAX, Seats};

    #[tokio::test]
    async fn one_address_takes_its_share_and_gives_it_back() {
        let seats = Seats::default();
        let [greedy, other] = ["192.168.1.2", "192.168.1.3"].map(|ip| ip.parse().unwrap());
        let mut taken = Vec::new();
        for _ in 0..OF_ONE_MAX {
            taken.push(seats.take(seats.room().await.unwrap(), greedy).unwrap());
        }
        assert!(seats.take(seats.room().await.unwrap(), greedy).is_none());
        let seat = seats.take(seats.room().await.unwrap(), other);
        assert!(seat.is_some());
        assert_eq!(seats.all.available_permits(), ALL_MAX - OF_ONE_MAX - 1);
        taken.pop();
        assert!(seats.take(seats.room().await.unwrap(), greedy).is_some());
        drop((taken, seat));
        assert_eq!(seats.all.available_permits(), ALL_MAX);
        assert!(seats.by_address.lock().unwrap().is_empty());
    }
}

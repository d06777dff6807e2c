//! Takes connections, not too many, and ends those whose peer takes nothing any more.

use std::collections::BTreeMap;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use axum::{Extension, Router};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use rustix::net::sockopt;
use tokio::net::{TcpListener, TcpStream};
use tracing::{debug, warn};

/// Connections at one time, in all and of one address. A client needs one or two, and one for each stream that it follows.
const ALL_MAX: usize = 64;
const OF_ONE_MAX: usize = 24;
/// Bytes of a request's head, the least that hyper accepts.
const HEAD_BYTES_MAX: usize = 8 << 10;
/// A client that takes longer for the head of a request is dropped, also one that asks nothing more.
const HEAD_TIME_MAX: Duration = Duration::from_secs(20);
/// A peer that takes nothing for so long is gone: the kernel ends its connection.
const SILENCE_MAX: Duration = Duration::from_secs(15);

/// What the kernel keeps for a peer that reads slowly: a few maps.
const SEND_BYTES: usize = 256 << 10;

/// Where a request comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Peer(pub(crate) IpAddr);

#[derive(Clone, Debug, Default)]
struct Seats(Arc<Mutex<BTreeMap<IpAddr, usize>>>);

/// Counts as one connection as long as it lives.
#[derive(Debug)]
struct Seat {
    seats: Seats,
    address: IpAddr,
}

impl Seats {
    fn take(&self, address: IpAddr) -> Option<Seat> {
        let mut taken = self.table();
        let all: usize = taken.values().sum();
        let own = taken.entry(address).or_default();
        if all >= ALL_MAX || *own >= OF_ONE_MAX {
            if *own == 0 {
                taken.remove(&address);
            }
            return None;
        }
        *own += 1;
        Some(Seat {
            seats: self.clone(),
            address,
        })
    }

    fn table(&self) -> MutexGuard<'_, BTreeMap<IpAddr, usize>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        let mut taken = self.seats.table();
        if let Some(own) = taken.get_mut(&self.address) {
            *own -= 1;
            if *own == 0 {
                taken.remove(&self.address);
            }
        }
    }
}

/// Takes connections for ever.
pub(crate) async fn accept(listener: TcpListener, router: Router) {
    let seats = Seats::default();
    loop {
        match listener.accept().await {
            Ok((stream, peer)) => {
                let address = peer.ip().to_canonical();
                let Some(seat) = seats.take(address) else {
                    debug!(%peer, "no seat for a connection");
                    continue;
                };
                let router = router.clone().layer(Extension(Peer(address)));
                tokio::spawn(async move {
                    serve(stream, router, SILENCE_MAX).await;
                    drop(seat);
                });
            }
            Err(error) => {
                warn!(%error, "cannot accept a connection");
                tokio::time::sleep(Duration::from_millis(100)).await;
            }
        }
    }
}

async fn serve(stream: TcpStream, router: Router, silence: Duration) {
    if let Err(error) = end_with_a_silent_peer(&stream, silence) {
        debug!(%error, "a connection without limits is not kept");
        return;
    }
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD_TIME_MAX)
        .max_buf_size(HEAD_BYTES_MAX)
        .serve_connection(TokioIo::new(stream), TowerToHyperService::new(router));
    if let Err(error) = connection.await {
        debug!(%error, "a connection ended early");
    }
}

/// Of a peer that is gone without a word, or takes nothing, the kernel knows best: it ends the connection, and what waits for it goes.
fn end_with_a_silent_peer(stream: &TcpStream, silence: Duration) -> std::io::Result<()> {
    stream.set_nodelay(true)?;
    sockopt::set_socket_send_buffer_size(stream, SEND_BYTES)?;
    let limit_ms = u32::try_from(silence.as_millis()).unwrap_or(u32::MAX);
    sockopt::set_tcp_user_timeout(stream, limit_ms)?;
    sockopt::set_socket_keepalive(stream, true)?;
    sockopt::set_tcp_keepidle(stream, silence)?;
    sockopt::set_tcp_keepintvl(stream, silence / 3)?;
    sockopt::set_tcp_keepcnt(stream, 3)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;
    use std::net::{IpAddr, Ipv4Addr};
    use std::time::Duration;

    use axum::Router;
    use axum::body::Body;
    use axum::routing::get;
    use futures_util::stream::repeat_with;
    use tokio::io::AsyncWriteExt as _;
    use tokio::net::{TcpListener, TcpStream};
    use tokio::time::timeout;

    use super::{ALL_MAX, OF_ONE_MAX, Seats, serve};

    #[tokio::test]
    async fn a_peer_that_reads_nothing_is_left() {
        let endless = || async { Body::from_stream(repeat_with(|| Ok::<_, Infallible>(vec![b'x'; 4_096]))) };
        let router = Router::new().route("/", get(endless));
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let mut peer = TcpStream::connect(listener.local_addr().unwrap()).await.unwrap();
        let (stream, _) = listener.accept().await.unwrap();
        peer.write_all(b"GET / HTTP/1.1\r\nHost: a\r\n\r\n")
            .await
            .unwrap();
        let served = serve(stream, router, Duration::from_secs(1));
        timeout(Duration::from_secs(30), served)
            .await
            .expect("the kernel ends a connection whose window stays shut");
        drop(peer);
    }

    #[test]
    fn one_address_takes_its_share_and_all_give_theirs_back() {
        let seats = Seats::default();
        let address = |number: usize| IpAddr::V4(Ipv4Addr::from_bits(u32::try_from(number).unwrap()));
        let of_one: Vec<_> = (0..100).map_while(|_| seats.take(address(1))).collect();
        assert_eq!(of_one.len(), OF_ONE_MAX);
        let others: Vec<_> = (2..1_000)
            .map_while(|number| seats.take(address(number)))
            .collect();
        assert_eq!(of_one.len() + others.len(), ALL_MAX);
        assert_eq!(seats.table().len(), 1 + others.len());
        drop((of_one, others));
        assert!(seats.table().is_empty());
        assert!(seats.take(address(1)).is_some());
    }
}

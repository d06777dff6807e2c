//! The network on which homes find the robot: multicast DNS on one interface, for as long as its addresses stay the same.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket};
use std::time::Duration;

use async_io::Async;
use rs_matter::Matter;
use rs_matter::crypto::Crypto;
use rs_matter::transport::network::mdns::builtin::{BuiltinMdns, Host};
use rs_matter::transport::network::mdns::{
    MDNS_IPV4_BROADCAST_ADDR, MDNS_IPV6_BROADCAST_ADDR, MDNS_SOCKET_DEFAULT_BIND_ADDR,
};
use socket2::{Domain, Protocol, Socket, Type};
use tokio::time::sleep;

/// So often it is looked whether addresses have changed, or a network is there at last.
const LOOK_EVERY: Duration = Duration::from_secs(5);

/// An interface, and where the robot is on it.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Link {
    name: String,
    index: u32,
    ipv4: Option<Ipv4Addr>,
    ipv6: Vec<Ipv6Addr>,
}

/// An address of an interface, as the system lists them.
#[derive(Clone, Debug)]
struct Address {
    name: String,
    index: u32,
    ip: IpAddr,
}

/// Announces the robot for ever. Without a network it waits for one.
pub(crate) async fn announce(matter: &Matter<'_>, crypto: impl Crypto, (wanted, host): (Option<&str>, &str)) {
    loop {
        let Some(link) = find(wanted) else {
            sleep(LOOK_EVERY).await;
            continue;
        };
        tracing::info!(network = link.name, ipv4 = ?link.ipv4, ipv6 = ?link.ipv6, "to be found here");
        let ended = tokio::select! {
            ended = announce_on(&link, matter, (&crypto, host)) => ended,
            () = until_changed(wanted, &link) => continue,
        };
        if let Err(error) = ended {
            tracing::warn!(error = format!("{error:#}"), "not to be found; it tries again");
        }
        sleep(LOOK_EVERY).await;
    }
}

async fn announce_on(
    link: &Link,
    matter: &Matter<'_>,
    (crypto, host): (impl Crypto, &str),
) -> anyhow::Result<()> {
    let socket = Async::<UdpSocket>::new_nonblocking(open(link)?)?;
    let host = Host {
        hostname: host,
        ip: link.ipv4.unwrap_or(Ipv4Addr::UNSPECIFIED),
        ipv6: &link.ipv6,
    };
    let mut responder = BuiltinMdns::new();
    let ended = responder
        .run(
            &socket,
            &socket,
            &host,
            link.ipv4,
            Some(link.index),
            matter,
            crypto,
        )
        .await;
    ended.map_err(|error| anyhow::anyhow!("multicast DNS: {error}"))
}

/// Other responders of the same computer keep theirs.
fn open(link: &Link) -> std::io::Result<UdpSocket> {
    let socket = Socket::new(Domain::IPV6, Type::DGRAM, Some(Protocol::UDP))?;
    socket.set_only_v6(false)?;
    socket.set_reuse_address(true)?;
    socket.set_reuse_port(true)?;
    socket.set_nonblocking(true)?;
    let place: SocketAddr = MDNS_SOCKET_DEFAULT_BIND_ADDR;
    socket.bind(&place.into())?;
    socket.set_multicast_if_v6(link.index)?;
    socket.join_multicast_v6(&MDNS_IPV6_BROADCAST_ADDR, link.index)?;
    if let Some(own) = link.ipv4 {
        socket.set_multicast_if_v4(&own)?;
        socket.join_multicast_v4(&MDNS_IPV4_BROADCAST_ADDR, &own)?;
    }
    Ok(socket.into())
}

async fn until_changed(wanted: Option<&str>, link: &Link) {
    loop {
        sleep(LOOK_EVERY).await;
        if find(wanted).as_ref() != Some(link) {
            return;
        }
    }
}

fn find(wanted: Option<&str>) -> Option<Link> {
    let listed = match if_addrs::get_if_addrs() {
        Ok(listed) => listed,
        Err(error) => {
            tracing::warn!(%error, "the system does not list its networks");
            return None;
        }
    };
    let up = listed
        .into_iter()
        .filter(|interface| !interface.is_loopback() && interface.is_oper_up());
    let addresses: Vec<Address> = up
        .filter_map(|interface| {
            let ip = interface.ip();
            let (name, index) = (interface.name, interface.index?);
            Some(Address { name, index, ip })
        })
        .collect();
    link(&addresses, wanted)
}

/// The wanted one, or the first that both kinds of addresses reach, or the first. One needs an address of IPv6: Matter stands on it.
fn link(addresses: &[Address], wanted: Option<&str>) -> Option<Link> {
    let mut links: Vec<Link> = Vec::new();
    for address in addresses {
        if wanted.is_some_and(|wanted| wanted != address.name) {
            continue;
        }
        let known = links.iter().position(|link| link.index == address.index);
        let place = known.unwrap_or_else(|| {
            links.push(Link {
                name: address.name.clone(),
                index: address.index,
                ipv4: None,
                ipv6: Vec::new(),
            });
            links.len() - 1
        });
        if let Some(link) = links.get_mut(place) {
            match address.ip {
                IpAddr::V4(ip) => link.ipv4 = link.ipv4.or(Some(ip)),
                IpAddr::V6(ip) => link.ipv6.push(ip),
            }
        }
    }
    links.retain(|link| !link.ipv6.is_empty());
    let both = links.iter().position(|link| link.ipv4.is_some()).unwrap_or(0);
    (both < links.len()).then(|| links.swap_remove(both))
}

#[cfg(test)]
mod tests {
    use super::{Address, link};

    #[test]
    fn the_wanted_network_or_the_first_that_matter_can_use() {
        let address = |name: &str, index, ip: &str| Address {
            name: name.to_owned(),
            index,
            ip: ip.parse().unwrap(),
        };
        let all = [
            address("docker0", 3, "172.17.0.1"),
            address("eth1", 4, "fe80::4"),
            address("wlan0", 5, "192.168.1.7"),
            address("wlan0", 5, "fe80::5"),
            address("wlan0", 5, "fd00::5"),
        ];
        let name = |addresses: &[Address], wanted| link(addresses, wanted).map(|link| link.name);
        assert_eq!(name(&all, None).as_deref(), Some("wlan0"));
        assert_eq!(name(&all, Some("eth1")).as_deref(), Some("eth1"));
        assert_eq!(name(&all, Some("docker0")), None);
        assert_eq!(name(&all[..2], None).as_deref(), Some("eth1"));
        assert_eq!(name(&all[..1], None), None);
        let wlan = link(&all, None).expect("a network");
        assert_eq!((wlan.ipv4.is_some(), wlan.ipv6.len()), (true, 2));
    }
}

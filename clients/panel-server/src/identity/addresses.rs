//! Addresses of this computer on home networks.

use std::net::IpAddr;

/// The private networks for which the robot's authority may vouch, as address and length of the prefix.
pub(super) const HOME_NETWORKS: [(IpAddr, u8); 6] = [
    (IpAddr::V4(std::net::Ipv4Addr::new(10, 0, 0, 0)), 8),
    (IpAddr::V4(std::net::Ipv4Addr::new(172, 16, 0, 0)), 12),
    (IpAddr::V4(std::net::Ipv4Addr::new(192, 168, 0, 0)), 16),
    (IpAddr::V4(std::net::Ipv4Addr::new(169, 254, 0, 0)), 16),
    (
        IpAddr::V6(std::net::Ipv6Addr::new(0xfc00, 0, 0, 0, 0, 0, 0, 0)),
        7,
    ),
    (
        IpAddr::V6(std::net::Ipv6Addr::new(0xfe80, 0, 0, 0, 0, 0, 0, 0)),
        10,
    ),
];

/// What the network interfaces have now, sorted. A computer that cannot list them has none, and is reached by its name.
pub(crate) fn own_addresses() -> Vec<IpAddr> {
    let interfaces = if_addrs::get_if_addrs().unwrap_or_default();
    let mut addresses: Vec<IpAddr> = interfaces
        .iter()
        .map(if_addrs::Interface::ip)
        .filter(|ip| is_at_home(*ip))
        .collect();
    addresses.sort_unstable();
    addresses.dedup();
    addresses
}

fn is_at_home(ip: IpAddr) -> bool {
    HOME_NETWORKS.iter().any(|(network, prefix)| match (ip, network) {
        (IpAddr::V4(ip), IpAddr::V4(network)) => {
            (ip.to_bits() ^ network.to_bits()).leading_zeros() >= u32::from(*prefix)
        }
        (IpAddr::V6(ip), IpAddr::V6(network)) => {
            (ip.to_bits() ^ network.to_bits()).leading_zeros() >= u32::from(*prefix)
        }
        _ => false,
    })
}

#[cfg(test)]
mod tests {
    use super::is_at_home;

    #[test]
    fn home_networks() {
        for home in [
            "10.1.2.3",
            "172.31.0.1",
            "192.168.1.9",
            "169.254.7.7",
            "fd00::1",
            "fe80::1",
        ] {
            assert!(is_at_home(home.parse().unwrap()), "{home}");
        }
        for other in [
            "172.32.0.1",
            "8.8.8.8",
            "127.0.0.1",
            "::1",
            "2001:db8::1",
            "11.0.0.1",
        ] {
            assert!(!is_at_home(other.parse().unwrap()), "{other}");
        }
    }
}

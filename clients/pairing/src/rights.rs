//! Which role each address needs, and what becomes of a request whose role is too low. The roles of requests stand beside them, in
//! [`rvac_api::VERBS`].

use rvac_api::{Request, Role, role_for};

/// Who may use something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Anybody on the network.
    Nobody,
    /// A client of this role or a higher one.
    Role(Role),
}

impl Need {
    /// Whether a client of `role`, or nobody known, may.
    #[must_use]
    pub fn is_met_by(self, role: Option<Role>) -> bool {
        match self {
            Self::Nobody => true,
            Self::Role(needed) => role.is_some_and(|role| role >= needed),
        }
    }
}

/// How an address is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Reading.
    Get,
    /// Changing.
    Post,
}

/// An address of the server's interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Route {
    /// How.
    pub method: Method,
    /// Where.
    pub path: &'static str,
    /// By whom.
    pub need: Need,
}

/// Every address below `/api/`, and the files that the server makes itself; one that ends with `/` stands for all that begin so. The page and
/// its files are for anybody: they hold no secret.
#[rustfmt::skip]
pub const ROUTES: [Route; 20] = [
    Route { method: Method::Get,  path: "/robot.crt",          need: Need::Nobody },
    Route { method: Method::Get,  path: "/robot.mobileconfig", need: Need::Nobody },
    Route { method: Method::Get,  path: "/api/openapi.json",   need: Need::Nobody },
    Route { method: Method::Get,  path: "/api/pairing",        need: Need::Nobody },
    Route { method: Method::Post, path: "/api/pairing/begin",  need: Need::Nobody },
    Route { method: Method::Post, path: "/api/pairing/finish", need: Need::Nobody },
    Route { method: Method::Post, path: "/api/pairing/match",  need: Need::Nobody },
    Route { method: Method::Post, path: "/api/pairing/matched", need: Need::Nobody },
    Route { method: Method::Get,  path: "/api/session",        need: Need::Role(Role::View) },
    Route { method: Method::Get,  path: "/api/ws",             need: Need::Role(Role::View) },
    Route { method: Method::Get,  path: "/api/runs/",          need: Need::Role(Role::View) },
    Route { method: Method::Get,  path: "/api/floors/archive", need: Need::Role(Role::View) },
    Route { method: Method::Get,  path: "/api/system",         need: Need::Role(Role::View) },
    Route { method: Method::Post, path: "/api/pairing/open",   need: Need::Role(Role::Admin) },
    Route { method: Method::Get,  path: "/api/clients",        need: Need::Role(Role::Admin) },
    Route { method: Method::Post, path: "/api/clients/revoke", need: Need::Role(Role::Admin) },
    Route { method: Method::Post, path: "/api/clients/role",   need: Need::Role(Role::Admin) },
    Route { method: Method::Get,  path: "/api/matter",         need: Need::Role(Role::Admin) },
    Route { method: Method::Get,  path: "/api/update",         need: Need::Role(Role::Admin) },
    Route { method: Method::Post, path: "/api/update",         need: Need::Role(Role::Admin) },
];

/// What can be done at an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ways {
    /// Reading alone.
    Read,
    /// Changing alone.
    Change,
    /// Both.
    Both,
}

/// The rows of an address.
fn routes_of(path: &str) -> impl Iterator<Item = &'static Route> {
    ROUTES
        .iter()
        .filter(move |route| route.path == path || route.path.ends_with('/') && path.starts_with(route.path))
}

/// What an address needs; one below `/api/` that is not in the table needs the highest role.
#[must_use]
pub fn need_of(path: &str) -> Need {
    match routes_of(path).next() {
        Some(route) => route.need,
        None if path.starts_with("/api/") => Need::Role(Role::Admin),
        None => Need::Nobody,
    }
}

/// What can be done at an address of the table.
#[must_use]
pub fn ways_of(path: &str) -> Option<Ways> {
    let takes = |method| routes_of(path).any(|route| route.method == method);
    match (takes(Method::Get), takes(Method::Post)) {
        (true, true) => Some(Ways::Both),
        (true, false) => Some(Ways::Read),
        (false, true) => Some(Ways::Change),
        (false, false) => None,
    }
}

/// Requests for which somebody must be beside the robot or at its console, whatever the role: what they do no rule of the robot checks.
pub const PRESENCE: [&str; 1] = ["raw"];

/// Why a request is not passed on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Denied {
    /// It is none.
    Unreadable,
    /// The role is too low.
    NotAllowed {
        /// Number of the request.
        id: Option<u32>,
        /// What it needs.
        needed: Role,
    },
    /// Nobody is known to be beside the robot.
    Absent,
}

/// Who asks.
#[derive(Clone, Copy, Debug)]
pub struct Asker {
    /// What it may do.
    pub role: Role,
    /// Somebody is known to be beside the robot.
    pub is_present: bool,
}

/// A request that `asker` may make, written anew, so that the daemon reads what was judged here and nothing else.
///
/// # Errors
/// See [`Denied`].
pub fn checked_request(text: &str, asker: Asker) -> Result<String, Denied> {
    let request: Request = serde_json::from_str(text).map_err(|_| Denied::Unreadable)?;
    let value = serde_json::to_value(&request).map_err(|_| Denied::Unreadable)?;
    let verb = value.get("c").and_then(|verb| verb.as_str()).unwrap_or_default();
    let needed = role_for(verb);
    if asker.role < needed {
        return Err(Denied::NotAllowed {
            id: request.id,
            needed,
        });
    }
    if !asker.is_present && PRESENCE.contains(&verb) {
        return Err(Denied::Absent);
    }
    Ok(value.to_string())
}

#[cfg(test)]
mod tests {
    use super::{Asker, Denied, Need, checked_request, need_of};
    use rvac_api::Role;

    fn beside(role: Role) -> Asker {
        Asker {
            role,
            is_present: true,
        }
    }

    fn away(role: Role) -> Asker {
        Asker {
            role,
            is_present: false,
        }
    }

    #[test]
    fn what_is_not_in_the_table_is_for_administrators() {
        assert_eq!(need_of("/api/new"), Need::Role(Role::Admin));
        assert_eq!(need_of("/"), Need::Nobody);
        assert_eq!(need_of("/api/pairing"), Need::Nobody);
    }

    #[test]
    fn what_no_rule_checks_needs_somebody_beside_the_robot() {
        let raw = r#"{"c":"raw","packet":"x"}"#;
        assert_eq!(checked_request(raw, away(Role::Admin)), Err(Denied::Absent));
        assert_eq!(checked_request(raw, beside(Role::Admin)).as_deref(), Ok(raw));
        let denied = checked_request(raw, beside(Role::Drive));
        assert!(matches!(denied, Err(Denied::NotAllowed { .. })), "{denied:?}");
    }

    #[test]
    fn a_request_is_written_anew() {
        assert_eq!(
            checked_request(r#"{ "id":7, "c":"stop", "extra":1 }"#, away(Role::View)).as_deref(),
            Ok(r#"{"c":"stop","id":7}"#)
        );
        assert_eq!(
            checked_request(r#"{"id":7,"c":"start"}"#, beside(Role::View)),
            Err(Denied::NotAllowed {
                id: Some(7),
                needed: Role::Drive
            })
        );
        for hidden in [r#"{"c":"stop","c":"start"}"#, "[]", "", r#"{"c":"fly"}"#] {
            assert!(checked_request(hidden, beside(Role::View)).is_err(), "{hidden}");
        }
    }
}

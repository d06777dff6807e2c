//! The time zone of the system, by its name.

use std::fs;
use std::path::Path;

use vthal_core::schedule::Zone;

/// What `/etc/localtime` points to, else what `/etc/timezone` says, else UTC.
pub(crate) fn system_zone() -> Zone {
    let target = fs::read_link("/etc/localtime").ok();
    let text = fs::read_to_string("/etc/timezone").ok();
    named(target.as_deref(), text.as_deref()).unwrap_or_else(Zone::utc)
}

fn named(localtime: Option<&Path>, timezone: Option<&str>) -> Option<Zone> {
    let linked = localtime
        .and_then(Path::to_str)
        .and_then(|path| path.split_once("/zoneinfo/"));
    let linked = linked.map(|(_, name)| name.trim_start_matches("posix/").trim_start_matches("right/"));
    let written = timezone.map(str::trim);
    [linked, written].into_iter().flatten().find_map(Zone::named)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::named;

    #[test]
    fn the_link_comes_first_and_else_the_file() {
        let name =
            |link: Option<&str>, text| named(link.map(Path::new), text).map(|zone| zone.name().to_owned());
        let tallinn = Some("Europe/Tallinn".to_owned());
        assert_eq!(
            name(Some("/usr/share/zoneinfo/Europe/Tallinn"), Some("UTC")),
            tallinn
        );
        assert_eq!(
            name(Some("../usr/share/zoneinfo/posix/Europe/Tallinn"), None),
            tallinn
        );
        assert_eq!(name(Some("/somewhere/else"), Some("Europe/Tallinn\n")), tallinn);
        assert_eq!(name(None, Some("nonsense")), None);
    }
}

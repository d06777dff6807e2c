//! The robot's certificate in the shapes in which devices take it.

use data_encoding::{BASE64, HEXUPPER};

use crate::console::Trust;
use crate::sha256;

impl Trust {
    /// The certificate in the form that Android and Windows require.
    #[must_use]
    pub fn der(&self) -> Option<Vec<u8>> {
        let body: String = self
            .pem
            .lines()
            .skip_while(|line| *line != "-----BEGIN CERTIFICATE-----")
            .skip(1)
            .take_while(|line| *line != "-----END CERTIFICATE-----")
            .collect();
        BASE64.decode(body.as_bytes()).ok().filter(|der| !der.is_empty())
    }

    /// A profile for iPhones and Macs.
    #[must_use]
    pub fn mobile_profile(&self) -> Option<String> {
        let der = self.der()?;
        let hash = sha256(&der);
        let (outer, inner) = (uuid(hash.first_chunk()?), uuid(hash.last_chunk()?));
        let (name, body) = (&self.host_name, BASE64.encode(&der));
        Some(format!(
            r#"<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE plist PUBLIC "-//Apple//DTD PLIST 1.0//EN" "http://www.apple.com/DTDs/PropertyList-1.0.dtd">
<plist version="1.0">
<dict>
<key>PayloadType</key><string>Configuration</string>
<key>PayloadVersion</key><integer>1</integer>
<key>PayloadIdentifier</key><string>librvac.{name}</string>
<key>PayloadUUID</key><string>{outer}</string>
<key>PayloadDisplayName</key><string>LibreRVAC {name}</string>
<key>PayloadDescription</key><string>Lets this device trust the robot {name}, and nothing else. Compare the fingerprint that rvac trust shows.</string>
<key>PayloadContent</key>
<array>
<dict>
<key>PayloadType</key><string>com.apple.security.root</string>
<key>PayloadVersion</key><integer>1</integer>
<key>PayloadIdentifier</key><string>librvac.{name}.certificate</string>
<key>PayloadUUID</key><string>{inner}</string>
<key>PayloadDisplayName</key><string>LibreRVAC {name}</string>
<key>PayloadContent</key><data>{body}</data>
</dict>
</array>
</dict>
</plist>
"#
        ))
    }
}

/// Sixteen bytes in the shape of a UUID: the same certificate is always the same profile.
fn uuid(bytes: &[u8; 16]) -> String {
    let text = HEXUPPER.encode(bytes);
    let parts = [0..8, 8..12, 12..16, 16..20, 20..32].map(|range| text.get(range).unwrap_or_default());
    parts.join("-")
}

#[cfg(test)]
mod tests {
    use crate::console::Trust;

    #[test]
    fn the_certificate_is_found_in_its_pem() {
        let mut trust = Trust {
            robot: String::new(),
            host_name: "rvac-aaaaaaaa.local".to_owned(),
            addresses: Vec::new(),
            pem: "-----BEGIN CERTIFICATE-----\nMTIz\nNDU2\n-----END CERTIFICATE-----\n".to_owned(),
            fingerprint: String::new(),
        };
        assert_eq!(trust.der().unwrap(), b"123456");
        let profile = trust.mobile_profile().unwrap();
        assert!(profile.contains("<data>MTIzNDU2</data>") && profile.contains("rvac-aaaaaaaa.local"));
        trust.pem.clear();
        assert_eq!(trust.der(), None);
        assert_eq!(trust.mobile_profile(), None);
    }
}

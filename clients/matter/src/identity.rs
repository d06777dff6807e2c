//! By what a home knows this robot: made once, at random, and kept.

use std::fmt::Write as _;
use std::io;

use anyhow::{Context as _, anyhow};
use rand::{Rng, RngExt as _};
use rs_matter::BasicCommData;
use rs_matter::dm::clusters::basic_info::BasicInfoConfig;
use rs_matter::dm::devices::test::{TEST_PID, TEST_VID};
use rs_matter::error::Error;
use rs_matter::pairing::DiscoveryCapabilities;
use rs_matter::pairing::qr::{CommFlowType, Qr, QrPayload, QrTextType, no_optional_data};
use rs_matter::sc::pase::{Spake2pVerifierPassword, Spake2pVerifierPasswordRef};
use serde::{Deserialize, Serialize};

use crate::node::DEVICE_TYPE;
use crate::store::Folder;

const FILE: &str = "identity.json";
/// Codes that the specification forbids, because people would guess them.
const TRIVIAL: [u32; 11] = [
    11_111_111, 22_222_222, 33_333_333, 44_444_444, 55_555_555, 66_666_666, 77_777_777, 88_888_888,
    99_999_999, 12_345_678, 87_654_321,
];
/// The largest code.
const PASSCODE_MAX: u32 = 99_999_998;
/// The largest number by which one of several devices that wait is told from the others.
const DISCRIMINATOR_MAX: u16 = 0xfff;
/// Around a QR code, in modules.
const QUIET_ZONE: u8 = 4;
/// A code of this kind and the text in it are far smaller.
const CODE_BYTES: usize = 4096;
/// A drawn code: about 40 lines of 40 characters of three bytes.
const DRAWING_BYTES: usize = 16 << 10;

/// What is kept.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Identity {
    passcode: u32,
    discriminator: u16,
    /// Also the name of the host in multicast DNS: twelve hexadecimal digits, as of a network card.
    serial: String,
}

impl Identity {
    /// The one that is kept, or a new one.
    pub(crate) fn kept(folder: &Folder, random: &mut impl Rng) -> anyhow::Result<Self> {
        let path = folder.path(FILE);
        let found = kept_file::newest(&path, "the identity for Matter", |text| {
            let kept: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
            kept.is_fit().then_some(kept).ok_or("no identity".to_owned())
        });
        for complaint in &found.complaints {
            tracing::warn!("{complaint}");
        }
        if let Some(identity) = found.value {
            return Ok(identity);
        }
        let fresh = Self::draw(random);
        let text = serde_json::to_vec(&fresh).map_err(io::Error::other)?;
        kept_file::replace_secret(&path, &text).with_context(|| format!("{}", path.display()))?;
        Ok(fresh)
    }

    fn draw(random: &mut impl Rng) -> Self {
        let serial: u64 = random.random_range(0..1 << 48);
        loop {
            let drawn = Self {
                passcode: random.random_range(1..=PASSCODE_MAX),
                discriminator: random.random_range(0..=DISCRIMINATOR_MAX),
                serial: format!("{serial:012X}"),
            };
            if drawn.is_fit() {
                return drawn;
            }
        }
    }

    fn is_fit(&self) -> bool {
        (1..=PASSCODE_MAX).contains(&self.passcode)
            && !TRIVIAL.contains(&self.passcode)
            && self.discriminator <= DISCRIMINATOR_MAX
            && self.serial.len() == 12
            && self.serial.bytes().all(|byte| byte.is_ascii_hexdigit())
    }

    pub(crate) fn serial(&self) -> &str {
        &self.serial
    }

    pub(crate) fn commissioning(&self) -> BasicCommData {
        let password = self.passcode.to_le_bytes();
        BasicCommData {
            password: Spake2pVerifierPassword::new_from_ref(Spake2pVerifierPasswordRef::new(&password)),
            discriminator: self.discriminator,
        }
    }

    /// What a controller shows of the robot. The vendor is the one that the standard sets apart for tests.
    pub(crate) fn details(&self) -> BasicInfoConfig<'_> {
        BasicInfoConfig {
            vid: TEST_VID,
            pid: TEST_PID,
            vendor_name: "LibreRVAC",
            product_name: "Robot vacuum",
            device_name: "Robot vacuum",
            device_type: Some(DEVICE_TYPE),
            hw_ver: 1,
            hw_ver_str: "1",
            sw_ver: 1,
            sw_ver_str: env!("CARGO_PKG_VERSION"),
            serial_no: &self.serial,
            unique_id: &self.serial,
            ..BasicInfoConfig::new()
        }
    }

    /// The text of the QR code.
    pub(crate) fn code_text(&self) -> anyhow::Result<String> {
        // Without the serial number, which would make it longer.
        let payload = QrPayload::new(
            DiscoveryCapabilities::IP,
            CommFlowType::Standard,
            self.commissioning(),
            TEST_VID,
            TEST_PID,
            "",
            no_optional_data as fn() -> _,
        );
        let mut letters = vec![0; CODE_BYTES];
        let (text, _) = payload.as_str(&mut letters).map_err(strange)?;
        Ok(text.to_owned())
    }

    /// The digits that people type.
    pub(crate) fn digits(&self) -> String {
        self.commissioning().compute_pretty_pairing_code().to_string()
    }

    /// The code as text, as a picture of letters, and as the digits that people type.
    pub(crate) fn code(&self) -> anyhow::Result<String> {
        let text = self.code_text()?;
        let (mut scratch, mut modules) = (vec![0; CODE_BYTES], vec![0; CODE_BYTES]);
        let code = Qr::compute(&text, &mut scratch, &mut modules).map_err(strange)?;
        let mut drawing = vec![0; DRAWING_BYTES];
        let (drawn, _) = code
            .as_str(QrTextType::Unicode, QUIET_ZONE, false, &mut drawing)
            .map_err(strange)?;
        let mut whole = String::new();
        // Its lines end with a word to terminals that says nothing here.
        writeln!(whole, "{}", drawn.replace("\u{1b}[0m", ""))?;
        writeln!(whole, "code   {text}")?;
        writeln!(whole, "digits {}", self.digits())?;
        Ok(whole)
    }
}

fn strange(error: Error) -> anyhow::Error {
    anyhow!("the code cannot be drawn: {error}")
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng as _;
    use rand::rngs::StdRng;

    use super::Identity;
    use crate::store::tests::scratch;

    #[test]
    fn an_identity_is_drawn_once_and_one_that_people_would_guess_is_none() {
        let folder = scratch("identity");
        let first = Identity::kept(&folder, &mut StdRng::seed_from_u64(1)).unwrap();
        let again = Identity::kept(&folder, &mut StdRng::seed_from_u64(2)).unwrap();
        assert_eq!(first, again);
        for passcode in [0, 12_345_678, 99_999_999, 100_000_000] {
            assert!(
                !Identity {
                    passcode,
                    ..first.clone()
                }
                .is_fit(),
                "{passcode}"
            );
        }
        std::fs::remove_dir_all(folder.path("")).unwrap();
    }

    #[test]
    fn the_code_is_that_of_the_specification() {
        // Vendor 0xFFF1, product 0x8001, on the network, 3840 and 20202021: the code in the documents of the reference implementation.
        let identity = Identity {
            passcode: 20_202_021,
            discriminator: 3840,
            serial: "00005E0053AF".to_owned(),
        };
        let code = identity.code().unwrap();
        assert!(code.contains("code   MT:-24J0AFN00KA0648G00"), "{code}");
        assert!(code.contains("digits 3497-011-2332"), "{code}");
    }
}

//! The processors of Linux boards that we pack for.

/// A processor and its instruction set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Machine {
    /// ARMv6 with hardware floating point: Raspberry Pi Zero and 1.
    #[value(name = "arm")]
    Armv6,
    /// ARMv7: 32-bit systems on Raspberry Pi 2 and later, Olimex A13.
    #[value(name = "armv7")]
    Armv7,
    /// 64-bit ARM: Raspberry Pi Zero 2 W and later.
    #[value(name = "arm64")]
    Arm64,
    /// PCs.
    #[value(name = "amd64")]
    Amd64,
}

impl Machine {
    pub(crate) const ALL: [Self; 4] = [Self::Armv6, Self::Armv7, Self::Arm64, Self::Amd64];

    /// What people and files call it.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Armv6 => "arm",
            Self::Armv7 => "armv7",
            Self::Arm64 => "arm64",
            Self::Amd64 => "amd64",
        }
    }

    /// Its name in the words of the compiler. All are static programs on musl, which run on any Linux of that processor.
    pub(crate) const fn triple(self) -> &'static str {
        match self {
            Self::Armv6 => "arm-unknown-linux-musleabihf",
            Self::Armv7 => "armv7-unknown-linux-musleabihf",
            Self::Arm64 => "aarch64-unknown-linux-musl",
            Self::Amd64 => "x86_64-unknown-linux-musl",
        }
    }

    /// Its name in the words of Debian, where both 32-bit ARMs are armhf: Raspberry Pi OS runs armhf on ARMv6, too.
    pub(crate) const fn debian(self) -> &'static str {
        match self {
            Self::Armv6 | Self::Armv7 => "armhf",
            Self::Arm64 => "arm64",
            Self::Amd64 => "amd64",
        }
    }
}

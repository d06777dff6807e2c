//! The values of the configuration's fields (section 3).

/// Where the system clock comes from after a reset (FNOSC).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum OscillatorSource {
    /// The internal oscillator, nominally 8 MHz.
    Internal = 0,
    /// The internal oscillator through the PLL.
    InternalPll = 1,
    /// The crystal or clock on OSC1.
    Primary = 2,
    /// The crystal or clock on OSC1 through the PLL.
    PrimaryPll = 3,
    /// The 32 kHz crystal on RC13 and RC14.
    Secondary = 4,
    /// The internal oscillator of about 31 kHz.
    LowPower = 5,
    /// The internal oscillator through 16.
    InternalBy16 = 6,
    /// The internal oscillator through OSCCON.FRCDIV.
    InternalDivided = 7,
}

/// What is on OSC1 and OSC2 (POSCMOD).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum PrimaryOscillator {
    /// A clock on OSC1.
    ExternalClock = 0,
    /// A crystal up to 10 MHz.
    Crystal = 1,
    /// A crystal, driven harder.
    HighSpeed = 2,
    /// Nothing.
    Off = 3,
}

macro_rules! factors {
    ($(#[$attribute:meta])* $name:ident { $($(#[$text:meta])* $variant:ident = $code:literal : $factor:literal,)* }) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum $name {
            $(
                $(#[$text])*
                #[doc = concat!("The factor is ", stringify!($factor), ".")]
                $variant = $code,
            )*
        }

        impl $name {
            /// The factor.
            #[must_use]
            pub const fn factor(self) -> u32 {
                match self {
                    $(Self::$variant => $factor,)*
                }
            }
        }
    };
}

factors! {
    /// Between oscillator and PLL (FPLLIDIV).
    InputDivider {
        By1 = 0: 1,
        By2 = 1: 2,
        By3 = 2: 3,
        By4 = 3: 4,
        By5 = 4: 5,
        By6 = 5: 6,
        By10 = 6: 10,
        By12 = 7: 12,
    }
}

factors! {
    /// The PLL's multiplier (FPLLMUL).
    Multiplier {
        Times15 = 0: 15,
        Times16 = 1: 16,
        Times17 = 2: 17,
        Times18 = 3: 18,
        Times19 = 4: 19,
        Times20 = 5: 20,
        Times21 = 6: 21,
        Times24 = 7: 24,
    }
}

factors! {
    /// Behind the PLL (FPLLODIV).
    OutputDivider {
        By1 = 0: 1,
        By2 = 1: 2,
        By4 = 2: 4,
        By8 = 3: 8,
        By16 = 4: 16,
        By32 = 5: 32,
        By64 = 6: 64,
        By256 = 7: 256,
    }
}

factors! {
    /// From the system clock to the peripherals' (FPBDIV).
    PeripheralDivider {
        By1 = 0: 1,
        By2 = 1: 2,
        By4 = 2: 4,
        By8 = 3: 8,
    }
}

//! Every port pin of the 100-pin package, and what is special about some (sections 8, 9, 11, 12 and 18).

use super::{AnalogPin, NoticePin, Pin, Reset};

macro_rules! pins {
    ($($field:ident $port:literal $number:literal;)*) => {
        /// All pins, in the state in which a reset leaves them.
        #[derive(Debug)]
        pub struct Pins {
            $(
                #[doc = concat!("Pin ", stringify!($number), " of port ", $port, ".")]
                pub $field: Pin<$port, $number, Reset>,
            )*
        }

        impl Pins {
            /// Once, by [`crate::Peripherals::take`].
            pub(crate) const fn new() -> Self {
                Self { $($field: Pin::new(),)* }
            }
        }
    };
}

macro_rules! notices {
    ($($notice:literal $port:literal $number:literal;)*) => {
        $(impl<Mode> NoticePin for Pin<$port, $number, Mode> {
            const NOTICE: u8 = $notice;
        })*
    };
}

macro_rules! analogs {
    ($($number:literal)*) => {
        $(impl<Mode> AnalogPin for Pin<'B', $number, Mode> {
            const CHANNEL: u8 = $number;
        })*
    };
}

// RC12 and RC15 carry the crystal when one is used.
pins! {
    ra0 'A' 0;
    ra1 'A' 1;
    ra2 'A' 2;
    ra3 'A' 3;
    ra4 'A' 4;
    ra5 'A' 5;
    ra6 'A' 6;
    ra7 'A' 7;
    ra9 'A' 9;
    ra10 'A' 10;
    ra14 'A' 14;
    ra15 'A' 15;
    rb0 'B' 0;
    rb1 'B' 1;
    rb2 'B' 2;
    rb3 'B' 3;
    rb4 'B' 4;
    rb5 'B' 5;
    rb6 'B' 6;
    rb7 'B' 7;
    rb8 'B' 8;
    rb9 'B' 9;
    rb10 'B' 10;
    rb11 'B' 11;
    rb12 'B' 12;
    rb13 'B' 13;
    rb14 'B' 14;
    rb15 'B' 15;
    rc1 'C' 1;
    rc2 'C' 2;
    rc3 'C' 3;
    rc4 'C' 4;
    rc12 'C' 12;
    rc13 'C' 13;
    rc14 'C' 14;
    rc15 'C' 15;
    rd0 'D' 0;
    rd1 'D' 1;
    rd2 'D' 2;
    rd3 'D' 3;
    rd4 'D' 4;
    rd5 'D' 5;
    rd6 'D' 6;
    rd7 'D' 7;
    rd8 'D' 8;
    rd9 'D' 9;
    rd10 'D' 10;
    rd11 'D' 11;
    rd12 'D' 12;
    rd13 'D' 13;
    rd14 'D' 14;
    rd15 'D' 15;
    re0 'E' 0;
    re1 'E' 1;
    re2 'E' 2;
    re3 'E' 3;
    re4 'E' 4;
    re5 'E' 5;
    re6 'E' 6;
    re7 'E' 7;
    re8 'E' 8;
    re9 'E' 9;
    rf0 'F' 0;
    rf1 'F' 1;
    rf2 'F' 2;
    rf3 'F' 3;
    rf4 'F' 4;
    rf5 'F' 5;
    rf6 'F' 6;
    rf7 'F' 7;
    rf8 'F' 8;
    rf12 'F' 12;
    rf13 'F' 13;
    rg0 'G' 0;
    rg1 'G' 1;
    rg2 'G' 2;
    rg3 'G' 3;
    rg6 'G' 6;
    rg7 'G' 7;
    rg8 'G' 8;
    rg9 'G' 9;
    rg12 'G' 12;
    rg13 'G' 13;
    rg14 'G' 14;
    rg15 'G' 15;
}

// Section 9.
notices! {
    0 'C' 14;
    1 'C' 13;
    2 'B' 0;
    3 'B' 1;
    4 'B' 2;
    5 'B' 3;
    6 'B' 4;
    7 'B' 5;
    8 'G' 6;
    9 'G' 7;
    10 'G' 8;
    11 'G' 9;
    12 'B' 15;
    13 'D' 4;
    14 'D' 5;
    15 'D' 6;
    16 'D' 7;
    17 'F' 4;
    18 'F' 5;
    19 'D' 13;
    20 'D' 14;
    21 'D' 15;
}

analogs! { 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 }

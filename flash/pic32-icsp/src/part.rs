//! Identities of parts: the lower 28 bits of what the chip reports; above is the revision.

/// A part of the PIC32MX3xx/4xx families.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its name without the maker's prefix.
    pub name: &'static str,
    /// Its identity.
    pub id: u32,
}

/// The part that this crate is for: that of the SR8730.
const PIC32MX360F256L: Part = Part {
    name: "PIC32MX360F256L",
    id: 0x0934_053,
};

/// Relatives, to say what was found.
const RELATIVES: [Part; 12] = [
    Part {
        name: "PIC32MX360F512L",
        id: 0x0938_053,
    },
    Part {
        name: "PIC32MX340F128L",
        id: 0x092D_053,
    },
    Part {
        name: "PIC32MX320F128L",
        id: 0x092A_053,
    },
    Part {
        name: "PIC32MX340F512H",
        id: 0x0916_053,
    },
    Part {
        name: "PIC32MX340F256H",
        id: 0x0912_053,
    },
    Part {
        name: "PIC32MX340F128H",
        id: 0x090D_053,
    },
    Part {
        name: "PIC32MX320F128H",
        id: 0x090A_053,
    },
    Part {
        name: "PIC32MX320F064H",
        id: 0x0906_053,
    },
    Part {
        name: "PIC32MX320F032H",
        id: 0x0902_053,
    },
    Part {
        name: "PIC32MX460F512L",
        id: 0x0978_053,
    },
    Part {
        name: "PIC32MX460F256L",
        id: 0x0974_053,
    },
    Part {
        name: "PIC32MX440F128L",
        id: 0x096D_053,
    },
];

impl Part {
    /// The part that this crate is for.
    pub const SR8730: Part = PIC32MX360F256L;

    /// Whether an identity is that of this part in any revision.
    pub const fn is(self, id: u32) -> bool {
        id & 0x0FFF_FFFF == self.id
    }

    /// The part with this identity, if it is known.
    pub fn of_id(id: u32) -> Option<Part> {
        let known = RELATIVES.iter().chain([&Self::SR8730]);
        known.copied().find(|part| part.is(id))
    }
}

#[cfg(test)]
mod tests {
    use super::{PIC32MX360F256L, Part, RELATIVES};

    #[test]
    fn identities_are_distinct_and_of_one_maker() {
        let all: Vec<Part> = RELATIVES.iter().chain([&PIC32MX360F256L]).copied().collect();
        for (index, part) in all.iter().enumerate() {
            assert_eq!(part.id & 0xFFF, 0x053, "{}", part.name);
            assert!(
                all[..index].iter().all(|other| other.id != part.id),
                "{}",
                part.name
            );
            assert_eq!(Part::of_id(0x5000_0000 | part.id), Some(*part));
        }
        assert_eq!(Part::of_id(0xFFFF_FFFF), None);
    }
}

//! What the loader says the chip is.

/// A chip of these families.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Model {
    /// Its name.
    pub name: &'static str,
    /// Its identity.
    pub id: u16,
    /// Bytes of program flash.
    pub code_bytes: usize,
}

/// The chip of the Vileda Relax.
const STC90C58RD: Model = Model {
    name: "STC90C58RD+",
    id: 0xF128,
    code_bytes: 0x8000,
};

/// Relatives, to say what was found.
const RELATIVES: [Model; 3] = [
    Model {
        name: "STC89C58RD+",
        id: 0xF108,
        code_bytes: 0x8000,
    },
    Model {
        name: "STC90C516RD+",
        id: 0xF130,
        code_bytes: 0x1_0000,
    },
    Model {
        name: "STC90C54RD+",
        id: 0xF124,
        code_bytes: 0x4000,
    },
];

impl Model {
    /// The chip of the Vileda Relax.
    pub const RELAX: Model = STC90C58RD;

    /// The model with this identity, if it is known.
    pub fn of_id(id: u16) -> Option<Model> {
        let known = RELATIVES.iter().chain([&Self::RELAX]);
        known.copied().find(|model| model.id == id)
    }
}

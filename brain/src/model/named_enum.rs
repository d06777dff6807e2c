//! Closed sets of reasons, each with the name that logs, recordings and clients show.

/// Declares an enum whose variants have names. Variants under `nested` hold another such enum and have its names.
macro_rules! named_enum {
    (
        $(#[$enum_doc:meta])* $name:ident {
            $($(#[$doc:meta])* $variant:ident => $text:literal,)+
        }
        $(nested { $($(#[$nested_doc:meta])* $nested:ident($inner:ty),)+ })?
    ) => {
        $(#[$enum_doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $name {
            $($(#[$doc])* $variant,)+
            $($($(#[$nested_doc])* $nested($inner),)+)?
        }

        impl $name {
            /// All of them.
            pub fn all() -> impl Iterator<Item = Self> {
                [$(Self::$variant,)+].into_iter()
                    $($(.chain(<$inner>::all().map(Self::$nested)))+)?
            }

            /// The name.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $text,)+
                    $($(Self::$nested(inner) => inner.name(),)+)?
                }
            }

            /// The one with exactly this name.
            #[must_use]
            pub fn from_name(name: &str) -> Option<Self> {
                Self::all().find(|one| one.name() == name)
            }
        }
    };
}

pub(crate) use named_enum;

#[cfg(test)]
mod tests {
    use crate::model::edit_error::EditError;
    use crate::model::fault::Fault;
    use crate::model::job_refusal::JobRefusal;
    use crate::model::link_fault::LinkFault;
    use crate::model::reason::Reason;

    #[test]
    fn names_are_unique_and_found_again() {
        assert!(Reason::all().all(|reason| Reason::from_name(reason.name()) == Some(reason)));
        assert!(Fault::all().all(|fault| Fault::from_name(fault.name()) == Some(fault)));
        assert!(LinkFault::all().all(|fault| LinkFault::from_name(fault.name()) == Some(fault)));
        assert!(EditError::all().all(|error| EditError::from_name(error.name()) == Some(error)));
        assert!(JobRefusal::all().all(|refusal| JobRefusal::from_name(refusal.name()) == Some(refusal)));
    }
}

//! What the run modes and the cleaning modes have in common: tables of modes, and answers.

use rs_matter::dm::ArrayAttributeRead;
use rs_matter::dm::clusters::decl::globals::{ModeOptionStructArrayBuilder, ModeOptionStructBuilder};
use rs_matter::error::{Error, ErrorCode};
use rs_matter::tlv::TLVBuilderParent;

/// `UnsupportedMode` of an answer.
pub(super) const UNSUPPORTED: u8 = 0x01;

/// A mode that can be chosen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mode {
    pub(super) id: u8,
    pub(super) label: &'static str,
    /// What machines know it by, from the cluster's own list.
    pub(super) tags: &'static [u16],
}

pub(super) fn write<P: TLVBuilderParent>(
    modes: &[Mode],
    builder: ArrayAttributeRead<ModeOptionStructArrayBuilder<P>, ModeOptionStructBuilder<P>>,
) -> Result<P, Error> {
    match builder {
        ArrayAttributeRead::ReadAll(mut all) => {
            for mode in modes {
                all = write_one(mode, all.push()?)?;
            }
            all.end()
        }
        ArrayAttributeRead::ReadOne(index, one) => {
            let mode = modes.get(usize::from(index)).ok_or(ErrorCode::ConstraintError)?;
            write_one(mode, one)
        }
        ArrayAttributeRead::ReadNone(all) => all.end(),
    }
}

fn write_one<P: TLVBuilderParent>(mode: &Mode, builder: ModeOptionStructBuilder<P>) -> Result<P, Error> {
    let mut tags = builder.label(mode.label)?.mode(mode.id)?.mode_tags()?;
    for tag in mode.tags {
        tags = tags.push()?.mfg_code(None)?.value(*tag)?.end()?;
    }
    tags.end()?.end()
}

#[cfg(test)]
pub(super) mod tests {
    use super::Mode;

    /// What the specification wants of a table of modes.
    pub(in crate::clusters) fn check(modes: &[Mode]) {
        assert!(modes.len() >= 2);
        for (index, mode) in modes.iter().enumerate() {
            assert!(
                !mode.tags.is_empty() && mode.tags.len() <= 8 && mode.label.len() <= 64,
                "{mode:?}"
            );
            for other in &modes[index + 1..] {
                assert!(
                    mode.id != other.id && mode.label != other.label,
                    "{mode:?} {other:?}"
                );
                let same = mode.tags.len() == other.tags.len()
                    && mode.tags.iter().all(|tag| other.tags.contains(tag));
                assert!(!same, "{mode:?} {other:?}");
            }
        }
    }
}

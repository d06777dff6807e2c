//! Sisters of a robot: whose firmware one takes, if anybody knows that it may.

use crate::codegen::board::Board;
use crate::codegen::machines::{self, BoardLikeness, MachineFacts};
use anyhow::bail;
use std::path::Path;

/// A robot and the sister of it that was meant, if it was one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Choice {
    pub(super) board: Board,
    pub(super) variant: Option<String>,
    /// How much more of the flash its firmware may take.
    pub(super) flash_allowance_bytes: u32,
}

/// Finds the robot of this name among those with firmware and their sisters; `None` when there is none.
pub(super) fn choose(root: &Path, boards: &[Board], name: &str) -> anyhow::Result<Option<Choice>> {
    if let Some(board) = boards.iter().find(|board| board.name == name) {
        let board = board.clone();
        return Ok(Some(Choice {
            board,
            variant: None,
            flash_allowance_bytes: 0,
        }));
    }
    for board in boards {
        let sisters = machines::variants(root, &board.facts)?;
        if let Some(sister) = sisters.iter().find(|sister| sister.name == name) {
            permit(sister, board)?;
            return Ok(Some(Choice {
                board: board.clone(),
                variant: Some(name.to_owned()),
                flash_allowance_bytes: sister.flash_allowance_bytes(),
            }));
        }
    }
    Ok(None)
}

/// Firmware of a board that nobody has compared can switch on two transistors of a bridge at once.
fn permit(sister: &MachineFacts, board: &Board) -> anyhow::Result<()> {
    let (title, name, base) = (&sister.title, &sister.name, &board.name);
    let look = format!("compare the board first: docs/book/src/machines/{name}.md");
    match sister.likeness() {
        Some(BoardLikeness::Same) => Ok(()),
        Some(BoardLikeness::Similar) => {
            bail!("nobody has compared the board of the {title} with that of {base}: {look}")
        }
        Some(BoardLikeness::Unknown) | None => {
            bail!("nobody knows whether the {title} has the board of {base}: {look}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::choose;
    use crate::codegen::board::Board;
    use crate::workspace;

    fn chosen(name: &str) -> Result<Option<(String, Option<String>)>, String> {
        let root = workspace::root();
        let boards = Board::all(&root).expect("they are described");
        let choice = choose(&root, &boards, name).map_err(|refusal| refusal.to_string())?;
        Ok(choice.map(|choice| (choice.board.name, choice.variant)))
    }

    #[test]
    fn a_sister_with_the_same_board_takes_the_firmware_of_its_base() {
        let of = |base: &str, sister: Option<&str>| Ok(Some((base.to_owned(), sister.map(str::to_owned))));
        assert_eq!(chosen("sr8730"), of("sr8730", None));
        assert_eq!(chosen("sr8750"), of("sr8730", Some("sr8750")));
        assert_eq!(chosen("m-488a"), of("relax", Some("m-488a")));
        assert_eq!(chosen("sr9999"), Ok(None));
    }

    #[test]
    fn a_sister_whose_board_nobody_knows_takes_none() {
        for (name, reason) in [
            (
                "sr8855",
                "nobody knows whether the Samsung Navibot SR8855 has the board of sr8730",
            ),
            (
                "relax-plus",
                "nobody has compared the board of the Vileda Relax Plus with that of relax",
            ),
        ] {
            let refusal = chosen(name).expect_err(name);
            assert!(refusal.starts_with(reason), "{refusal}");
            assert!(
                refusal.ends_with(&format!("docs/book/src/machines/{name}.md")),
                "{refusal}"
            );
        }
    }
}

//! Programs and a chip that are texts: what a board makes of an update, without a robot.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fs;
use std::rc::Rc;

use rvac_update::{Attempt, Board, BoardError, Chip, ChipError, Health, Programs, Slots};

use crate::update_world::Supply;

/// What the daemon finds when it starts.
pub trait RobotEnd {
    /// Whether the robot would greet.
    fn speaks(&self) -> bool;
    /// Whether it is at work.
    fn works(&self) -> bool {
        false
    }
}

/// Programs that are files: one that begins with "broken" does not answer.
#[derive(Debug)]
pub struct ModelBoard<R> {
    pub(crate) supply: Rc<Supply>,
    pub(crate) slots: Slots,
    /// What runs.
    pub runs: Programs,
    pub(crate) robot: Rc<RefCell<R>>,
}

impl<R: RobotEnd> Board for ModelBoard<R> {
    fn restart(&mut self) -> Result<(), BoardError> {
        self.supply.step().map_err(|error| BoardError::Command {
            command: "restart".to_owned(),
            error,
        })?;
        self.runs = self.slots.current();
        Ok(())
    }

    fn works(&mut self) -> bool {
        self.robot.borrow().works()
    }

    fn look(&mut self) -> Health {
        let answers = |program: &str| match self.runs {
            Programs::Package => true,
            Programs::Update(slot) => {
                let text = fs::read_to_string(self.slots.folder(slot).join(program)).unwrap_or_default();
                !text.is_empty() && !text.starts_with("broken")
            }
        };
        let daemon = answers("bin/vthal");
        Health {
            daemon,
            robot: daemon && self.robot.borrow().speaks(),
            panel: answers("bin/panel-server"),
        }
    }

    fn wait_for(&mut self, _: Health) -> Health {
        // The time of a minute passes at once.
        match self.supply.step() {
            Ok(()) => self.look(),
            Err(_) => Health::default(),
        }
    }
}

/// A chip as a text: empty while it is erased.
#[derive(Clone, Debug, Default)]
pub struct ModelChip {
    /// What is in it.
    pub content: String,
    kept: BTreeMap<String, String>,
    verified: Option<String>,
    /// Whether it can be read.
    pub is_readable: bool,
    /// Whether it says no when it is looked at.
    pub is_unreachable: bool,
    /// Whether its robot is at work.
    pub is_at_work: bool,
}

impl ModelChip {
    /// A chip that can be read, with this in it.
    pub fn with(content: &str) -> Self {
        Self {
            content: content.to_owned(),
            is_readable: true,
            ..Self::default()
        }
    }
}

impl RobotEnd for ModelChip {
    fn speaks(&self) -> bool {
        self.content.starts_with("firmware")
    }

    fn works(&self) -> bool {
        self.is_at_work
    }
}

/// The chip with its supply.
#[derive(Debug)]
pub struct ModelChipPort {
    pub(crate) supply: Rc<Supply>,
    pub(crate) chip: Rc<RefCell<ModelChip>>,
}

impl ModelChipPort {
    fn put(&mut self, text: &str) -> Result<(), ChipError> {
        let half = &text[..text.len() / 2];
        for content in ["", half, text] {
            self.supply
                .step()
                .map_err(|error| ChipError::NotWritten(error.to_string()))?;
            // Half an image says nothing that a daemon would understand.
            self.chip.borrow_mut().content = match content == text {
                true => text.to_owned(),
                false => format!("half {content}"),
            };
        }
        self.chip.borrow_mut().verified = Some(text.to_owned());
        Ok(())
    }
}

impl Chip for ModelChipPort {
    fn check(&mut self, _: &[u8]) -> Result<(), ChipError> {
        match self.chip.borrow().is_unreachable {
            true => Err(ChipError::Unreachable("the robot is not on its dock".to_owned())),
            false => Ok(()),
        }
    }

    fn verified(&self) -> Option<String> {
        self.chip.borrow().verified.clone()
    }

    fn keep(&mut self) -> Result<Option<String>, ChipError> {
        self.supply
            .step()
            .map_err(|error| ChipError::NotKept(error.to_string()))?;
        let mut chip = self.chip.borrow_mut();
        if !chip.is_readable {
            return Ok(None);
        }
        let content = chip.content.clone();
        chip.kept.insert("kept".to_owned(), content);
        Ok(Some("kept".to_owned()))
    }

    fn write(&mut self, hex: &[u8], _: Attempt) -> Result<(), ChipError> {
        self.put(&String::from_utf8_lossy(hex))
    }

    fn restore(&mut self, name: &str) -> Result<(), ChipError> {
        let kept = self.chip.borrow().kept.get(name).cloned();
        self.put(&kept.ok_or_else(|| ChipError::NotWritten("nothing is kept".to_owned()))?)
    }
}

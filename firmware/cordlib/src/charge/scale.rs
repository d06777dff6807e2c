//! Limits of one pack: values of a cell times the number of cells, rates from its capacity.

use rvac_protocol::message::ChargeFault;

use crate::parameters::PackParameters;

/// Limits of a pack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PackLimits {
    cells: i32,
    capacity_mah: i32,
    current_max_ma: i32,
}

impl PackLimits {
    pub(super) fn of(pack: &PackParameters) -> Self {
        Self {
            cells: i32::from(pack.cells),
            capacity_mah: i32::from(pack.capacity_mah),
            current_max_ma: i32::from(pack.current_max_ma),
        }
    }

    const fn cells(self, cell_mv: i32) -> i32 {
        self.cells.saturating_mul(cell_mv)
    }

    /// Below this there is no pack: 0.5 V a cell.
    pub(super) const fn present_mv(self) -> i32 {
        self.cells(500)
    }

    /// Below this a cell may be reversed: 0.8 V a cell.
    pub(super) const fn deep_mv(self) -> i32 {
        self.cells(800)
    }

    /// Below this the pack is precharged: 1.0 V a cell.
    pub(super) const fn precharge_mv(self) -> i32 {
        self.cells(1_000)
    }

    /// A resting pack below this is charged: 1.30 V a cell.
    pub(super) const fn recharge_mv(self) -> i32 {
        self.cells(1_300)
    }

    /// No sound pack shows more: 1.70 V a cell.
    pub(super) const fn voltage_max_mv(self) -> i32 {
        self.cells(1_700)
    }

    /// -dV: fall from the peak that means full, 80 mV for twelve cells.
    pub(super) const fn negative_delta_v_mv(self) -> i32 {
        self.cells.saturating_mul(80) / 12
    }

    /// 0dV: a rise below this in 20 minutes means full, 10 mV for twelve cells.
    pub(super) const fn zero_delta_v_mv(self) -> i32 {
        let limit_mv = self.cells.saturating_mul(10) / 12;
        if limit_mv < 1 { 1 } else { limit_mv }
    }

    /// 1.3 times the capacity, in mA s.
    pub(super) const fn charge_max_mas(self) -> u32 {
        self.capacity_mas() / 10 * 13
    }

    /// The capacity in mA s.
    pub(super) const fn capacity_mas(self) -> u32 {
        (self.capacity_mah as u32).saturating_mul(3_600)
    }

    /// What a cool pack gets: at most a tenth of the capacity an hour. A converter without noise shows a current wrong by most of
    /// a count, which is 108 mA, so the set point is half of that.
    pub(super) const fn cool_ma(self) -> i32 {
        self.slow_ma() / 2
    }

    /// A tenth of the capacity an hour.
    pub(super) const fn slow_ma(self) -> i32 {
        let slow_ma = self.capacity_mah / 10;
        if slow_ma < self.full_ma() {
            slow_ma
        } else {
            self.full_ma()
        }
    }

    /// Set point of the full current: 5 % below the limit, to leave room for ripple.
    pub(super) const fn full_ma(self) -> i32 {
        self.current_max_ma.saturating_sub(self.current_max_ma / 20)
    }

    /// Why a resting pack with this voltage must not be charged, if so.
    pub(super) const fn unfit(self, pack_mv: i32) -> Option<ChargeFault> {
        if pack_mv < self.present_mv() || pack_mv >= self.voltage_max_mv() {
            Some(ChargeFault::NoBattery)
        } else if pack_mv < self.deep_mv() {
            Some(ChargeFault::DeepDischarge)
        } else {
            None
        }
    }

    /// Whether a cell or a contact must have failed between these two averages of a second: 1 V for twelve cells.
    pub(super) const fn is_jump(self, before_mv: i32, now_mv: i32) -> bool {
        now_mv.saturating_sub(before_mv).saturating_abs() > self.cells.saturating_mul(1_000) / 12
    }

    /// Current above which the duty is cut at once: a tenth above the limit.
    pub(super) const fn fold_back_ma(self) -> i32 {
        self.current_max_ma.saturating_add(self.current_max_ma / 10)
    }

    /// Current that is a fault: a quarter above the limit.
    pub(super) const fn over_current_ma(self) -> i32 {
        self.current_max_ma.saturating_add(self.current_max_ma / 4)
    }
}

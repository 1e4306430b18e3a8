//! Four numbers at a time: sums in one order on every processor, without waiting for one another.

use wide::f64x4;

/// Numbers side by side.
pub(in crate::filters) type Lanes = f64x4;

/// Number of [`Lanes`].
pub(in crate::filters) const LANES: usize = 4;

/// Blocks of lanes that hold `count` numbers; the last is filled up with zeros.
pub(in crate::filters) const fn blocks(count: usize) -> usize {
    count.div_ceil(LANES)
}

/// The numbers of a block. Made of the numbers themselves and not of a copy, which would be written one by
/// one and read as a vector.
#[inline(always)]
pub(in crate::filters) fn block(numbers: &[f64], index: usize) -> Lanes {
    match numbers[index * LANES..] {
        [a, b, c, d, ..] => Lanes::new([a, b, c, d]),
        [a, b, c] => Lanes::new([a, b, c, 0.0]),
        [a, b] => Lanes::new([a, b, 0.0, 0.0]),
        [a] => Lanes::new([a, 0.0, 0.0, 0.0]),
        [] => Lanes::ZERO,
    }
}

/// Sum of the lanes.
#[inline(always)]
pub(in crate::filters) fn sum(lanes: Lanes) -> f64 {
    let [a, b, c, d] = lanes.to_array();
    (a + c) + (b + d)
}

/// The numbers of all blocks, zeros at the end included.
#[inline(always)]
pub(in crate::filters) fn numbers(lanes: &[Lanes]) -> &[f64] {
    bytemuck::cast_slice(lanes)
}

/// A state after the newest update and after the one before, which turn by turn lie in the same memory.
///
/// What is made of the older state does not wait for the newest update: with the few numbers of that
/// update it is the same as what is made of the newest state.
#[derive(Clone, Debug)]
pub(in crate::filters) struct Turns {
    states: [Box<[Lanes]>; 2],
    is_second_newest: bool,
}

impl Turns {
    /// The same state twice: as if the update before had changed nothing.
    pub(in crate::filters) fn new(state: Vec<Lanes>) -> Self {
        let state = state.into_boxed_slice();
        Self {
            states: [state.clone(), state],
            is_second_newest: false,
        }
    }

    /// State after the newest update.
    pub(in crate::filters) fn newest(&self) -> &[Lanes] {
        &self.states[usize::from(self.is_second_newest)]
    }

    /// State after the newest update and, to be written over, the one before.
    #[inline(always)]
    pub(in crate::filters) fn newest_and_older(&mut self) -> (&[Lanes], &mut [Lanes]) {
        let [first, second] = &mut self.states;
        if self.is_second_newest {
            (second, first)
        } else {
            (first, second)
        }
    }

    /// Makes what was written over the older state the newest one.
    #[inline(always)]
    pub(in crate::filters) fn turn(&mut self) {
        self.is_second_newest = !self.is_second_newest;
    }
}

//! The same operations, same order of accumulation and so the same bits, interleaved.
//!
//! The control machine of the paper waits for each sum; deep pipelines then gain nothing. A
//! scheduler that starts other rows meanwhile keeps the units busy. This one is greedy: in each
//! clock it walks the operations in the order of the paper's schedule (`y` straight after the
//! denominator) and starts every one whose operands are ready, whose unit is free and whose
//! memory ports are free, reads in the starting clock, writes in the last one. Elements of R and
//! W are read into a latch before they are corrected, as the paper's register RR does;
//! accumulators and latches are not counted: a controller reaches this length only with enough
//! of them.

use super::clocks::RlsLoad;
use crate::fpga::check::check_tap_count;
use crate::fpga::error::FpgaError;
use crate::fpga::timing::Units;
use crate::vocabulary::Division;

/// How the operations may be interleaved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScheduleSettings {
    /// Accesses per clock and memory, 1 or 2.
    pub ram_ports: u64,
    /// Store and update only the elements on and above the diagonal of R (same bits: R is
    /// symmetric to the last one).
    pub symmetric_half: bool,
}

/// What limits the sample rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// The port of RAMA is the busiest resource.
    RamaPort,
    /// The port of RAMB is the busiest resource.
    RambPort,
    /// The multiplier is the busiest resource.
    Multiplier,
    /// The adder is the busiest resource.
    Adder,
    /// The divider is the busiest resource.
    Divider,
    /// No resource is busy: the chain of dependent operations decides.
    DependencyChain,
}

impl Bound {
    /// Name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::RamaPort => "RAMA port",
            Self::RambPort => "RAMB port",
            Self::Multiplier => "multiplier",
            Self::Adder => "adder",
            Self::Divider => "divider",
            Self::DependencyChain => "dependency chain",
        }
    }
}

/// Length of the interleaved schedule and what limits it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ScheduleReport {
    /// Clocks per sample, the loading clock included.
    pub clocks: u64,
    /// The resource busy in at least 90 % of the clocks, if any; else the dependency chain.
    pub bound: Bound,
    /// Multiplications per sample.
    pub multiplies: u64,
    /// Additions and subtractions per sample, the `+0 +` of each dot product included.
    pub additions: u64,
    /// Divisions per sample.
    pub divisions: u64,
    /// Accesses of RAMA per sample.
    pub rama_accesses: u64,
    /// Accesses of RAMB per sample.
    pub ramb_accesses: u64,
}

/// Clocks per RLS sample of the greedy list schedule.
///
/// # Errors
/// [`FpgaError::TapCount`], [`FpgaError::CountOutOfRange`].
pub fn schedule_clocks(
    load: RlsLoad,
    units: Units,
    settings: ScheduleSettings,
) -> Result<ScheduleReport, FpgaError> {
    check_tap_count(load.tap_count)?;
    units.check()?;
    if !(1..=2).contains(&settings.ram_ports) {
        return Err(FpgaError::CountOutOfRange {
            name: "RAM ports",
            value: settings.ram_ports,
            range: "1 or 2",
        });
    }
    let chained = load.forgets && units.forgetting_clocks(true) == 0;
    let graph = Graph::of(load, settings.symmetric_half, chained);
    let clocks = place(&graph.operations, units, settings.ram_ports);
    Ok(graph.report(clocks, units, settings.ram_ports))
}

/// Operations of one sample, each on its own: what a design needs that has no accumulator to start
/// at zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Operations {
    pub(super) multiplies: u64,
    pub(super) additions: u64,
    pub(super) divisions: u64,
    /// Clocks of all of them one after the other, each read, operated and written.
    pub(super) serial_clocks: u64,
}

/// Counts the operations of the schedule one by one.
pub(super) fn count_operations(load: RlsLoad) -> Operations {
    const READ_OPERATE_WRITE: u64 = 3;
    let mut counted = Operations::default();
    for operation in &Graph::of(load, false, false).operations {
        if operation.adds_to_zero || operation.unit == Unit::Move {
            continue;
        }
        match operation.unit {
            Unit::Adder => counted.additions += 1,
            Unit::Multiplier => counted.multiplies += 1,
            Unit::Divider => counted.divisions += 1,
            Unit::AdderAndMultiplier | Unit::Move => unreachable!("nothing is chained here"),
        }
        counted.serial_clocks += READ_OPERATE_WRITE;
    }
    counted
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Unit {
    Adder,
    /// A subtraction and the product behind it in one clock: takes adder and multiplier.
    AdderAndMultiplier,
    Multiplier,
    Divider,
    /// No arithmetic: a word moves between a port or memory and a register.
    Move,
}

/// Memory accesses of an operation: 1 or 0 each.
#[derive(Clone, Copy, Debug, Default)]
struct Ports {
    reads_a: u64,
    reads_b: u64,
    writes_a: u64,
    writes_b: u64,
}

const fn ports([reads_a, reads_b]: [u64; 2], [writes_a, writes_b]: [u64; 2]) -> Ports {
    Ports {
        reads_a,
        reads_b,
        writes_a,
        writes_b,
    }
}

const READ_BOTH: Ports = ports([1, 1], [0, 0]);
const READ_A: Ports = ports([1, 0], [0, 0]);
const READ_B: Ports = ports([0, 1], [0, 0]);
const WRITE_BOTH: Ports = ports([0, 0], [1, 1]);
const WRITE_A: Ports = ports([0, 0], [1, 0]);
const WRITE_B: Ports = ports([0, 0], [0, 1]);
const REGISTER: Ports = ports([0, 0], [0, 0]);

#[derive(Clone, Debug)]
struct Operation {
    unit: Unit,
    operands: [Option<usize>; 2],
    ports: Ports,
    /// Whether this is the `+0 +` with which an accumulator begins.
    adds_to_zero: bool,
}

struct Graph {
    operations: Vec<Operation>,
}

impl Graph {
    fn push(&mut self, unit: Unit, operands: [Option<usize>; 2], ports: Ports) -> usize {
        self.operations.push(Operation {
            unit,
            operands,
            ports,
            adds_to_zero: false,
        });
        self.operations.len() - 1
    }

    /// Products of L with a row of RAMB, summed in order from `+0`; `operands[j]` must precede
    /// product j.
    fn dot(&mut self, operands: &[usize], last: Ports) -> usize {
        let first = self.operations.len() + operands.len();
        let sum = self.dot_from_word(operands, last);
        self.operations[first].adds_to_zero = true;
        sum
    }

    /// The same from a word that is not zero.
    fn dot_from_word(&mut self, operands: &[usize], last: Ports) -> usize {
        let products: Vec<usize> = operands
            .iter()
            .map(|operand| self.push(Unit::Multiplier, [Some(*operand), None], READ_BOTH))
            .collect();
        let mut sum = None;
        for (j, product) in products.iter().enumerate() {
            let ports = if j + 1 == products.len() {
                last
            } else {
                REGISTER
            };
            sum = Some(self.push(Unit::Adder, [Some(*product), sum], ports));
        }
        sum.expect("a dot product has at least one tap")
    }

    /// All operations of one sample, in the order of the paper's schedule.
    fn of(load: RlsLoad, symmetric_half: bool, chained: bool) -> Self {
        let p = load.tap_count;
        let mut graph = Self {
            operations: Vec::new(),
        };
        let loaded = graph.push(Unit::Move, [None, None], WRITE_A);
        let after_load = vec![loaded; p];
        let t: Vec<usize> = (0..p).map(|_| graph.dot(&after_load, WRITE_BOTH)).collect();
        let denominator = graph.dot_from_word(&t, REGISTER);
        let reciprocal = match load.division {
            Division::Reciprocal => {
                Some(graph.push(Unit::Divider, [Some(denominator), None], REGISTER))
            }
            Division::Elementwise => None,
        };
        let output = graph.dot(&after_load, REGISTER);
        let mut corrected = vec![0; p * p];
        for i in 0..p {
            for j in 0..p {
                corrected[i * p + j] = if symmetric_half && j < i {
                    corrected[j * p + i]
                } else {
                    let product = graph.push(Unit::Multiplier, [Some(t[i]), Some(t[j])], READ_BOTH);
                    let scaled = match reciprocal {
                        Some(word) => {
                            graph.push(Unit::Multiplier, [Some(product), Some(word)], REGISTER)
                        }
                        None => {
                            let operands = [Some(product), Some(denominator)];
                            graph.push(Unit::Divider, operands, REGISTER)
                        }
                    };
                    graph.correct(loaded, scaled, load.forgets, chained)
                };
            }
        }
        let gains: Vec<usize> = corrected
            .chunks(p)
            .map(|row| graph.dot(row, WRITE_A))
            .collect();
        let error = graph.push(Unit::Adder, [Some(output), None], REGISTER);
        for gain in gains {
            let product = graph.push(Unit::Multiplier, [Some(gain), Some(error)], READ_A);
            let fetched = graph.push(Unit::Move, [Some(loaded), None], READ_B);
            graph.push(Unit::Adder, [Some(product), Some(fetched)], WRITE_B);
        }
        graph
    }

    /// `(R - correction) * ialpha` for one element, written back.
    fn correct(&mut self, loaded: usize, scaled: usize, forgets: bool, chained: bool) -> usize {
        let fetched = self.push(Unit::Move, [Some(loaded), None], READ_B);
        let operands = [Some(scaled), Some(fetched)];
        if chained {
            self.push(Unit::AdderAndMultiplier, operands, WRITE_B)
        } else if forgets {
            let difference = self.push(Unit::Adder, operands, REGISTER);
            self.push(Unit::Multiplier, [Some(difference), None], WRITE_B)
        } else {
            self.push(Unit::Adder, operands, WRITE_B)
        }
    }

    fn report(&self, clocks: u64, units: Units, ram_ports: u64) -> ScheduleReport {
        let (mut multiplies, mut additions, mut divisions) = (0, 0, 0);
        let (mut rama_accesses, mut ramb_accesses) = (0, 0);
        for operation in &self.operations {
            match operation.unit {
                Unit::Adder => additions += 1,
                Unit::Multiplier => multiplies += 1,
                Unit::AdderAndMultiplier => {
                    additions += 1;
                    multiplies += 1;
                }
                Unit::Divider => divisions += 1,
                Unit::Move => {}
            }
            rama_accesses += operation.ports.reads_a + operation.ports.writes_a;
            ramb_accesses += operation.ports.reads_b + operation.ports.writes_b;
        }
        let busy = [
            (Bound::RambPort, ramb_accesses.div_ceil(ram_ports)),
            (Bound::RamaPort, rama_accesses.div_ceil(ram_ports)),
            (
                Bound::Multiplier,
                multiplies * units.multiplier.interval_clocks,
            ),
            (Bound::Adder, additions * units.adder.interval_clocks),
            (Bound::Divider, divisions * units.divider.interval_clocks),
        ];
        let mut bound = Bound::DependencyChain;
        let mut most = 0;
        for (candidate, clocks_busy) in busy {
            if 10 * clocks_busy >= 9 * clocks && clocks_busy > most {
                bound = candidate;
                most = clocks_busy;
            }
        }
        ScheduleReport {
            clocks,
            bound,
            multiplies,
            additions,
            divisions,
            rama_accesses,
            ramb_accesses,
        }
    }
}

/// Uses of one resource per clock, growing as needed.
#[derive(Default)]
struct Reservation(Vec<u64>);

impl Reservation {
    fn used(&self, clock: usize) -> u64 {
        self.0.get(clock).copied().unwrap_or(0)
    }

    fn take(&mut self, clock: usize, count: u64) {
        if self.0.len() <= clock {
            self.0.resize(clock + 1, 0);
        }
        self.0[clock] += count;
    }
}

/// Unit bookkeeping of the scheduler: first clock in which each unit is free again.
struct UnitState {
    adder_free: usize,
    multiplier_free: usize,
    divider_free: usize,
}

/// Places every operation and returns the clock after the last result.
fn place(operations: &[Operation], units: Units, ram_ports: u64) -> u64 {
    let latency = |unit: Unit| {
        let clocks = match unit {
            Unit::Adder => units.adder.latency_clocks,
            Unit::Multiplier => units.multiplier.latency_clocks,
            Unit::Divider => units.divider.latency_clocks,
            Unit::AdderAndMultiplier | Unit::Move => 1,
        };
        usize::try_from(clocks).expect("latencies are at most 1000")
    };
    let interval = |clocks: u64| usize::try_from(clocks).expect("intervals are at most 1000");
    let mut ready = vec![usize::MAX; operations.len()];
    let (mut rama, mut ramb) = (Reservation::default(), Reservation::default());
    let mut state = UnitState {
        adder_free: 0,
        multiplier_free: 0,
        divider_free: 0,
    };
    let mut waiting: Vec<usize> = (0..operations.len()).collect();
    let (mut clock, mut end) = (0, 0);
    while !waiting.is_empty() {
        waiting.retain(|index| {
            let operation = &operations[*index];
            let done = clock + latency(operation.unit);
            let is_ready = operation
                .operands
                .iter()
                .flatten()
                .all(|k| ready[*k] <= clock);
            let is_free = match operation.unit {
                Unit::Adder => state.adder_free <= clock,
                Unit::Multiplier => state.multiplier_free <= clock,
                Unit::AdderAndMultiplier => state.adder_free.max(state.multiplier_free) <= clock,
                Unit::Divider => state.divider_free <= clock,
                Unit::Move => true,
            };
            let Ports {
                reads_a,
                reads_b,
                writes_a,
                writes_b,
            } = operation.ports;
            // An operation reads at its start and writes in its last clock; none does both.
            let has_ports = rama.used(clock) + reads_a <= ram_ports
                && ramb.used(clock) + reads_b <= ram_ports
                && rama.used(done - 1) + writes_a <= ram_ports
                && ramb.used(done - 1) + writes_b <= ram_ports;
            if !(is_ready && is_free && has_ports) {
                return true;
            }
            rama.take(clock, reads_a);
            ramb.take(clock, reads_b);
            rama.take(done - 1, writes_a);
            ramb.take(done - 1, writes_b);
            if matches!(operation.unit, Unit::Adder | Unit::AdderAndMultiplier) {
                state.adder_free = clock + interval(units.adder.interval_clocks);
            }
            if matches!(operation.unit, Unit::Multiplier | Unit::AdderAndMultiplier) {
                state.multiplier_free = clock + interval(units.multiplier.interval_clocks);
            }
            if operation.unit == Unit::Divider {
                state.divider_free = clock + interval(units.divider.interval_clocks);
            }
            ready[*index] = done;
            end = end.max(done);
            false
        });
        clock += 1;
    }
    end as u64
}

//! Filters on trial: noise beside delay, DC gain, memory and bound; claims of the literature.

mod cli_claim;
mod docket;
mod least_noise;
mod metrology;
mod moving_noise;
mod side_by_side;
mod verdicts;

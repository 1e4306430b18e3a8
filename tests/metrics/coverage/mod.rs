//! Whether the intervals of a record hold the mean over seeds as often as they say.
//!
//! Every metric of every channel under every motion is a cell. Its ensemble value is the mean over the
//! seeds of the trial; an interval counts where it holds that value. A cell fails when the exact
//! binomial 99.9 % interval of its coverage misses 93 to 97 %, or where its mean half width exceeds
//! 1.25 times what the scatter of the seeds asks for.
//!
//! `FOGBENCH_COVERAGE=<seeds>` runs the long form and prints the table of docs/intervals.md;
//! `FOGBENCH_COVERAGE_S=<seconds>` sets the length of its records, `FOGBENCH_COVERAGE_MOTION=<name>` runs one
//! motion alone: rest, swing, steps or staircase.

mod cells;
mod trial;

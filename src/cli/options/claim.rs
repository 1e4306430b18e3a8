//! What may be said of claims.

use clap::{ArgGroup, Args};

use crate::cli::options::format::Format;
use crate::cli::options::numbers::within;
use crate::metrics::{Claim, ClaimedFigure};
use crate::recording::SAMPLE_RATE_HZ;

/// Sizes of a figure of noise, in its unit.
const FIGURE: (f64, f64) = (1e-12, 1e12);
/// Averaging times, s: up to 115 days.
const AVERAGING_TIME_S: (f64, f64) = (1e-6, 1e7);
/// Averaging time at which an angle random walk is read off the Allan deviation, s.
const ARW_AVERAGING_TIME_S: f64 = 1.0;

/// Options of `claim`.
#[derive(Args, Debug)]
#[command(group(ArgGroup::new("figure").required(true).args(["arw_before", "bias_stability"])))]
pub(in crate::cli) struct ClaimOptions {
    /// Angle random walk before, deg/sqrt(h)
    #[arg(long, value_name = "N", requires = "arw_after", conflicts_with = "bias_stability",
          allow_negative_numbers = true,
          value_parser = within(FIGURE.0, FIGURE.1, "deg/sqrt(h)"))]
    arw_before: Option<f64>,
    /// Angle random walk afterwards, deg/sqrt(h)
    #[arg(long, value_name = "N", requires = "arw_before", conflicts_with = "bias_stability",
          allow_negative_numbers = true,
          value_parser = within(FIGURE.0, FIGURE.1, "deg/sqrt(h)"))]
    arw_after: Option<f64>,
    /// Bias stability before and afterwards, deg/h: standard deviations of means over the averaging
    /// time, which must be given
    #[arg(long, value_names = ["BEFORE", "AFTER"], num_args = 2, requires = "averaging_time_s",
          allow_negative_numbers = true,
          value_parser = within(FIGURE.0, FIGURE.1, "deg/h"))]
    bias_stability: Option<Vec<f64>>,
    /// Averaging time at which the figures were read, s [default: 1 for an angle random walk]
    #[arg(long, value_name = "S", allow_negative_numbers = true,
          value_parser = within(AVERAGING_TIME_S.0, AVERAGING_TIME_S.1, "s"))]
    averaging_time_s: Option<f64>,
    /// Words per second: the taps of the mean are counted [default: they are not]
    #[arg(long, value_name = "HZ", allow_negative_numbers = true,
          value_parser = within(SAMPLE_RATE_HZ.0, SAMPLE_RATE_HZ.1, "Hz"))]
    pub(in crate::cli) rate_hz: Option<f64>,
    /// Form of the answer
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(in crate::cli) format: Format,
}

impl ClaimOptions {
    /// The claim.
    ///
    /// # Panics
    /// If clap let neither or half a figure through.
    pub(in crate::cli) fn claim(&self) -> Claim {
        let averaging_time_s = self.averaging_time_s.unwrap_or(ARW_AVERAGING_TIME_S);
        let (figure, before, after) = match (self.bias_stability.as_deref(), self.arw_before) {
            (Some([before, after]), _) => (ClaimedFigure::BiasStability, *before, *after),
            (_, before) => {
                let pair = before.zip(self.arw_after);
                let (before, after) =
                    pair.expect("clap asks for one figure, before and afterwards");
                (ClaimedFigure::AngleRandomWalk, before, after)
            }
        };
        Claim {
            figure,
            before,
            after,
            averaging_time_s,
        }
    }
}

//! Words of the filters.

use super::word::words;

words! {
    /// What an adaptive filter aims at.
    pub enum DesiredSignal {
        /// The current sample, `d = x[k]`.
        Current = "current",
        /// The mean of the newest two samples, `d = (x[k] + x[k-1]) / 2`.
        TwoSampleMean = "two-sample-mean",
    }

    /// When a filter's result appears.
    pub enum OutputRegister {
        /// At the next sample tick: the output at sample k is `y[k-1]`, the first output is 0.
        NextSample = "next-sample",
        /// At the tick of the sample it was computed from.
        Immediate = "immediate",
    }

    /// Sign before the error term of the weight update, with the error `e = d - y`.
    pub enum UpdateSign {
        /// Plus: the form that converges.
        Corrected = "corrected",
        /// Minus, as the paper's equations (6) and (9) print it: diverges, and is kept to show it.
        AsPrinted = "as-printed",
    }

    /// Arithmetic of a filter.
    pub enum Pipeline {
        /// The textbook recursion.
        Textbook = "textbook",
        /// The pipeline of the hardware: every bit and every clock.
        Fpga = "fpga",
    }

    /// How the weights of a line enhancer are corrected.
    pub enum SignLmsForm {
        /// By the sign of the error, over the energy: the patent's equation (34).
        ///
        /// `w + mu x sgn(e) / (alpha + |x|^2)` with `sgn(0) = 0`. The step mu has the unit of the
        /// words: the output moves by at most mu per sample, whatever the error.
        Sign = "sign",
        /// By the error, over the energy: equation (33), normalised least mean squares.
        ///
        /// `w + mu x e / (alpha + |x|^2)`, mu without unit, stable for `0 < mu < 2`.
        Nlms = "nlms",
        /// By the error, over the energy, the sum of the weights left alone.
        ///
        /// The normalised form along the part of x that leaves the sum alone, `x - mean(x)`: from
        /// weights of sum 1 the DC gain stays 1.
        UnityGain = "unity-gain",
    }

    /// Unit in which the constants of a line enhancer are meant.
    pub enum ConstantUnit {
        /// Degrees per hour, the unit of the words.
        DegPerH = "deg/h",
        /// Degrees per second.
        DegPerS = "deg/s",
        /// Radians per second.
        RadPerS = "rad/s",
    }

    /// Weights of a line enhancer at the start.
    pub enum InitialWeights {
        /// 1/M in every tap: the mean of the taps.
        Mean = "mean",
        /// Zero.
        Zero = "zero",
    }
}

impl DesiredSignal {
    /// Weights on the samples of age 0, 1, ...
    #[must_use]
    pub const fn weights(self) -> &'static [f64] {
        match self {
            Self::Current => &[1.0],
            Self::TwoSampleMean => &[0.5, 0.5],
        }
    }
}

impl OutputRegister {
    /// Samples that the register adds to the age of an output.
    #[must_use]
    pub const fn samples(self) -> usize {
        match self {
            Self::NextSample => 1,
            Self::Immediate => 0,
        }
    }
}

impl UpdateSign {
    /// +1 or -1.
    #[must_use]
    pub const fn factor(self) -> f64 {
        match self {
            Self::Corrected => 1.0,
            Self::AsPrinted => -1.0,
        }
    }
}

//! Words of the hardware pipelines.

use super::word::{UnknownWord, Word, words};

words! {
    /// Words of a hardware pipeline.
    pub enum NumberFormat {
        /// IEEE 754 binary64.
        Binary64 = "binary64",
        /// IEEE 754 binary32.
        Binary32 = "binary32",
        /// binary64, subnormal numbers flushed to zero.
        Binary64FlushToZero = "binary64-ftz",
        /// binary32, subnormal numbers flushed to zero.
        Binary32FlushToZero = "binary32-ftz",
    }

    /// How a fixed-point value between two words is rounded.
    pub enum Rounding {
        /// To the word below: the bits are cut off.
        Truncate = "truncate",
        /// To the nearest word, half way to the one above.
        HalfUp = "half-up",
        /// To the nearest word, half way to the even one.
        NearestEven = "nearest-even",
    }

    /// What becomes of a fixed-point value beyond the ends of the words.
    pub enum Overflow {
        /// The end.
        Saturate = "saturate",
        /// The bits beyond are cut off.
        Wrap = "wrap",
    }

    /// Where recursive least squares divides in the update of the inverse correlation.
    pub enum Division {
        /// Once per sample.
        ///
        /// `rcp = 1 / den`, then `(t_i t_j) rcp`.
        Reciprocal = "reciprocal",
        /// Once for each element of the matrix.
        ///
        /// `(t_i t_j) / den`: equation (8) of the paper to the letter.
        Elementwise = "elementwise",
    }

    /// Order of the two products in the update of the inverse correlation matrix R.
    pub enum UpdateOrder {
        /// `(t_i t_j) rcp`, the hardware's: both products commute and R stays symmetric to the last bit.
        Schedule = "schedule",
        /// `(t_i rcp) t_j`, the common textbook order, the gain vector first.
        ///
        /// The rounding errors of `R[i][j]` and `R[j][i]` differ, and their difference grows as
        /// `alpha^-k`: it fails below a forgetting factor of 1.
        GainFirst = "gain-first",
    }

    /// Floating-point units of an export of RTL.
    pub enum UnitSource {
        /// Computed by the simulator: fast, for simulation only.
        Behavioural = "behavioural",
        /// Verilog that synthesises.
        Synthesizable = "synthesizable",
    }

    /// Family of devices that an export of RTL is synthesised for.
    pub enum Device {
        /// Lattice iCE40.
        Ice40 = "ice40",
        /// Lattice ECP5.
        Ecp5 = "ecp5",
        /// AMD 7 series.
        Xilinx = "xilinx",
    }

    /// What an export of a pipeline writes.
    pub enum ExportForm {
        /// Stimulus, response, memories, parameters and per-clock trace.
        Vectors = "vectors",
        /// VCD and FST of the first samples.
        Waveform = "waveform",
        /// Verilog with a self-checking testbench, its vectors and a script.
        Rtl = "rtl",
    }
}

/// Words of a hardware pipeline that can also be fixed point, each signal with a format of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(try_from = "String")]
pub enum WordFormat {
    /// Floating point.
    Float(NumberFormat),
    /// Fixed point.
    Fixed,
}

impl WordFormat {
    /// Number of choices.
    const COUNT: usize = NumberFormat::ALL.len() + 1;

    /// The spelling in files and on the command line.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Float(format) => format.word(),
            Self::Fixed => "fixed",
        }
    }
}

impl Word for WordFormat {
    const ALL: &'static [Self] = &{
        let mut all = [Self::Fixed; Self::COUNT];
        let mut index = 0;
        while index < NumberFormat::ALL.len() {
            all[index] = Self::Float(NumberFormat::ALL[index]);
            index += 1;
        }
        all
    };
    const WORDS: &'static [&'static str] = &{
        let mut words = [""; Self::COUNT];
        let mut index = 0;
        while index < Self::COUNT {
            words[index] = Self::ALL[index].word();
            index += 1;
        }
        words
    };

    fn about(self) -> &'static str {
        match self {
            Self::Float(format) => format.about(),
            Self::Fixed => "Fixed point, a format for each signal",
        }
    }
}

impl std::fmt::Display for WordFormat {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.word())
    }
}

impl std::str::FromStr for WordFormat {
    type Err = UnknownWord;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let mut all = Self::ALL.iter().copied();
        all.find(|format| format.word() == text).ok_or(UnknownWord {
            expected: Self::WORDS,
        })
    }
}

impl TryFrom<String> for WordFormat {
    type Error = UnknownWord;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        text.parse()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_format_of_words_is_read_as_it_is_written() {
        assert_eq!(WordFormat::ALL.len(), NumberFormat::ALL.len() + 1);
        for (format, word) in WordFormat::ALL.iter().zip(WordFormat::WORDS) {
            assert_eq!(format.to_string(), *word);
            assert_eq!(word.parse::<WordFormat>().as_ref(), Ok(format));
            assert!(!format.about().is_empty());
        }
        let refused = "fix".parse::<WordFormat>().unwrap_err().to_string();
        assert!(refused.ends_with("binary32-ftz, fixed"), "{refused}");
    }
}

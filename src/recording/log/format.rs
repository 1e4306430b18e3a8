//! What may be said of a log: one declaration for files (`[log]`), options and their documents.

use super::motion::LogMotion;
use super::rows::LogRows;
use crate::declare::table;
use crate::recording::layout::Asked;
use crate::recording::layout::words::{
    DecimalSign, Encoding, HeadingUnits, MissingWords, Separator, WordKind, WordType,
};
use crate::recording::time::unit::TimeUnit;
use crate::recording::unit::kinds::LogUnit;
use crate::recording::unit::spelling::Spelled;
use crate::vocabulary::CaseAxis;
use serde::Serialize;

table! {
    /// How a log is read. What is not given is found from the first lines of the file.
    #[derive(Default, Serialize)]
    pub struct LogFormat {
        /// The log that a scenario measures, in place of table and gyro: NPY, NPZ, or text with columns.
        file: Option<String>, example "log.csv", kind File;
        /// Type of the words of a file that holds nothing else, no heading either: `i2` and the like of 1 to 8
        /// bytes, `u2`, `f4`, `f8`; `i2-be` if the high byte comes first.
        dtype: Option<WordType>, example "i2";
        /// Samples per second [default: what the column of the time says].
        rate_hz: Option<f64>, example 100.0, in 1e-6..=1e9, "Hz";
        /// Unit of the numbers: deg/h, deg/s or dps, mdeg/s, arcsec/s, rad/s, nrad/s, rpm and the like; as
        /// angles turned in a sample deg/sample, urad/sample; as an angle deg, rad [default: that of the
        /// heading].
        unit: Option<LogUnit>, example "deg/s";
        /// What a number is: `rate`, `increment` (the angle turned in a sample), `angle` (a running one)
        /// [default: what the unit says].
        kind: Option<WordKind>, example "rate";
        /// Units that one count of the log stands for; a negative one turns the sense of the axis
        /// [default: 1].
        scale: Option<f64>, example 0.0076, in -1e30..=1e30;
        /// Added to the numbers behind the scale, in their unit [default: 0].
        offset: Option<f64>, example 0.5, in -1e30..=1e30;
        /// Column by its heading, a part of it, its number from 1, or with `*` for any letters; several one
        /// after another, as an option between commas, a heading that holds one in `"` [default: the only one
        /// beside the time].
        column: Option<Vec<String>>, example ["gyro_z"];
        /// Column of what the gyro should show, such as the rate or the encoder's angle of the table, or
        /// another gyro: it takes the place of the true rate.
        reference_column: Option<String>, example "table_deg_per_s";
        /// Unit of the reference, an angle for an encoder [default: that of its heading].
        reference_unit: Option<LogUnit>, example "deg/s";
        /// Column of the temperature, deg C: bias and scale factor are measured against it and its rate, or
        /// follow it where a calibration is applied.
        temperature_column: Option<String>, example "coil_c";
        /// Temperature that its coefficients are told at [default: the mean of the log].
        temperature_reference_c: Option<f64>, example 25.0, in -100.0..=150.0, "C";
        /// A calibration.toml whose table temperature is taken out of the words by the column of the
        /// temperature, or, beside --columns, whose parameters of an assembly are.
        calibration: Option<String>, example "calibration.toml", kind File;
        /// Gyro of an assembly that the log is of: that of the table [temperature.x], or of three columns the
        /// one that is measured.
        axis: Option<CaseAxis>, example "x";
        /// Column of the time; of two, such as week and seconds, the sum; `none` if the file has none
        /// [default: the one whose heading says so].
        time: Option<Vec<String>>, example ["time_s"];
        /// Unit of each column of the time: s, ms, us, ns, min, h, day, week, iso (dates), sample (a
        /// counter) [default: that of the heading, else s].
        time_unit: Option<Vec<TimeUnit>>, example ["s"];
        /// Number of steps, in the unit of the time, after which a counter of time begins again at 0
        /// [default: found where stamps fall back by a power of two, a day or a week].
        roll_over: Option<f64>, example 65536.0, in 1e-9..=1e20;
        /// Lines at the start of the file to pass over.
        skip_lines: Option<u32>, example 4, in 0..=1000000;
        /// What begins a line that is passed over; without it `#`, `//`, `%`, and `;` where it does
        /// not separate.
        comment: Option<String>, example "//";
        /// Line of the heading, from 1; 0 if there is none.
        heading_line: Option<u32>, example 5, in 0..=1000000;
        /// Line of the units, from 1; 0 if there is none.
        units_line: Option<u32>, example 6, in 0..=1000000;
        /// What stands between cells: `comma`, `semicolon`, `tab`, `blanks`.
        separator: Option<Separator>, example "semicolon";
        /// Decimal sign: `point` or `comma`.
        decimal: Option<DecimalSign>, example "comma";
        /// Encoding of the text: `utf-8`, `utf-16-le`, `utf-16-be`, `latin-1`.
        encoding: Option<Encoding>, example "utf-8";
        /// Columns of a record whose values are read row by row, however many stand in a line: 1 where the
        /// lines hold one quantity, as many as there are quantities where a record is spread over lines.
        wrapped_columns: Option<u32>, example 1, in 1..=4096;
        /// What units in headings are worth: `read`, or `ignore` where the options are right.
        heading_units: Option<HeadingUnits>, example "read";
        /// What a word for a missing number is: `refuse`, or `gap`.
        missing: Option<MissingWords>, example "gap";
        /// First row that is taken, from 1, and the last: `1001:5000`; either may be left out.
        rows: Option<LogRows>, example "1001:5000";
        /// Time from the first stamp on at which the part that is taken begins.
        from_s: Option<f64>, example 10.0, in 0.0..=1e12, "s";
        /// Time at which it ends.
        to_s: Option<f64>, example 3600.0, in 0.0..=1e12, "s";
        /// Stretches to take: a table with the columns from_s and to_s; metrics pool them.
        segments: Option<String>, example "segments.csv", kind File;
        /// Cut the log where samples are missing, and pool the stretches between: no difference spans a gap.
        split_gaps: Option<bool>, example true;
        /// Most samples that may be missing in a gap which differences of the Allan deviation span, where their
        /// angles exist [default: none is spanned].
        gap_aware: Option<u32>, example 3, in 1..=1000000;
        /// Longest step between stamps that is jitter and no gap [default: one and a half sample periods].
        max_gap_s: Option<f64>, example 0.02, in 1e-9..=1e9, "s";
        /// What the gyro did: `static` (rest or constant rate), `swing:F`, F in Hz, or `dwells` (rates held one
        /// after the other, which are found in the reference) [default: static].
        motion: Option<LogMotion>, example "static";
        /// Time at the start of each dwell that is left out, for the gyro to settle [default: 0.5].
        settle_s: Option<f64>, example 2.0, in 0.0..=1e6, "s";
        /// Shortest averaging time of the noise fit: longer than the noise is correlated
        /// [default: what the correlation of the log asks for, and ten samples at least unless the words are
        /// white].
        fit_tau_min_s: Option<f64>, example 0.1, in 1e-9..=1e7, "s";
    }
}

impl LogFormat {
    /// Columns that are read beside the words, in the order in which they stand behind them.
    pub(in crate::recording) fn beside(&self) -> impl Iterator<Item = Asked<'_>> {
        let both = [
            (&self.reference_column, "reference_column"),
            (&self.temperature_column, "temperature_column"),
        ];
        both.into_iter()
            .filter_map(|(name, key)| Some(Asked::by(name.as_deref()?, key)))
    }

    /// What is said of the reference: its unit alone, of which an angle runs on.
    ///
    /// * `in_heading`: what the heading of its column says.
    pub(in crate::recording) fn of_reference(&self, in_heading: Option<Spelled>) -> Self {
        let is_angle = match self.reference_unit {
            Some(given) => matches!(given, LogUnit::Angle(_)),
            None => matches!(in_heading, Some(Spelled::Angle(_))),
        };
        Self {
            unit: self.reference_unit,
            kind: is_angle.then_some(WordKind::Angle),
            scale: None,
            offset: None,
            ..self.clone()
        }
    }
}

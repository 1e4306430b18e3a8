//! Settings of a motion given point by point.

use crate::declare::table;

table! {
    /// A motion of one's own, from a CSV file with the columns time_s and rate_deg_per_s or angle_deg;
    /// a line that begins with "#" is a comment. Its values enter the manifest, its digest the list of
    /// input files. The file cannot be swept.
    pub struct ScriptConfig,
    one "source of points" of file | points
    {
        /// Path of the file, relative to the file that names it (to the working directory in --set).
        file: Option<String>, example "motion.csv",
            apart "its columns have been put in the place of the points";
        points: ScriptPoints;
    }
}

table! {
    /// Points of a script: as many rates or angles as there are times.
    pub struct ScriptPoints,
    one "kind of values" of rate_deg_per_s | angle_deg
    {
        /// Times from the start of the record: the first is 0, each is at least an output sample after the
        /// one before it, the last is the duration or later.
        time_s: Vec<f64>, example [0.0, 5.0, 20.0], in 0.0..=1e7, "s";
        /// Rates, joined by straight lines; the first is held through the warm-up.
        rate_deg_per_s: Option<Vec<f64>>, example [0.0, 10.0, -10.0], in -2000.0..=2000.0, "deg/s";
        /// Angles, joined by monotone cubics; the table rests before the first and comes to rest at the
        /// last.
        angle_deg: Option<Vec<f64>>, example [0.0, 90.0, 0.0], in -1e6..=1e6, "deg";
    }
}

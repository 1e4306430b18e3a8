//! The compensation of a run in its table.

use crate::report::layout::text::wrapped;
use crate::signal::CompensationSheet;

const INDENT: &str = "  ";

/// Source, form and what both forms leave of the mean rates.
pub(crate) fn compensation_text(sheet: &CompensationSheet, width: usize) -> String {
    let form = match sheet.form {
        "first-order" => "first order (patent, equations 23 and 24)",
        _ => "exact inverse",
    };
    let temperature = if sheet.follows_temperature {
        ", bias by the temperature of the coil"
    } else {
        ""
    };
    let line = format!(
        "compensation: {form}{temperature}, {}; bias {} deg/h, scale factor error {} ppm, {} arcsec",
        sheet.source,
        triple(sheet.bias_deg_per_h, 4),
        triple(sheet.scale_factor_error_ppm, 2),
        sheet
            .theta_arcsec
            .map(|(name, angle)| format!("theta_{name} {angle:.2}"))
            .join(", "),
    );
    let left = format!(
        "perfect parameters would leave of the mean true rate {} deg/h: exact {} deg/h, first order \
         {} deg/h",
        triple(sheet.rate_deg_per_h, 3),
        triple(sheet.exact_residual_deg_per_h, 4),
        triple(sheet.first_order_residual_deg_per_h, 4),
    );
    wrapped(&line, INDENT, width) + &wrapped(&left, INDENT, width)
}

fn triple(values: [f64; 3], decimals: usize) -> String {
    // A zero has no sign worth printing.
    let texts = values.map(|value| format!("{:.decimals$}", value + 0.0));
    format!("({})", texts.join(", "))
}

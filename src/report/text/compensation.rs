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
    wrapped(&line, INDENT, width) + &wrapped(&left_text(sheet), INDENT, width)
}

/// What both forms leave, where that can be said in numbers.
fn left_text(sheet: &CompensationSheet) -> String {
    let rates = [
        sheet.rate_deg_per_h,
        sheet.exact_residual_deg_per_h,
        sheet.first_order_residual_deg_per_h,
    ];
    if !rates.iter().flatten().all(|rate| rate.is_finite()) {
        return "what perfect parameters would leave of the mean true rate is no finite number in this \
                record"
            .to_owned();
    }
    format!(
        "perfect parameters would leave of the mean true rate {} deg/h: exact {} deg/h, first order \
         {} deg/h",
        triple(sheet.rate_deg_per_h, 3),
        triple(sheet.exact_residual_deg_per_h, 4),
        triple(sheet.first_order_residual_deg_per_h, 4),
    )
}

fn triple(values: [f64; 3], decimals: usize) -> String {
    // A zero has no sign worth printing.
    let texts = values.map(|value| format!("{:.decimals$}", value + 0.0));
    format!("({})", texts.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_that_is_no_number_is_not_printed_as_one() {
        let mut sheet = CompensationSheet {
            form: "exact",
            source: "calibration.toml".to_owned(),
            bias_deg_per_h: [0.0; 3],
            scale_factor_error_ppm: [0.0; 3],
            theta_arcsec: ["xy", "xz", "yx", "yz", "zx", "zy"].map(|name| (name, 0.0)),
            follows_temperature: false,
            rate_deg_per_h: [7.5; 3],
            exact_residual_deg_per_h: [0.0; 3],
            first_order_residual_deg_per_h: [0.25; 3],
        };
        let sound = compensation_text(&sheet, 1000);
        assert!(sound.contains("first order (0.2500, 0.2500, 0.2500) deg/h"));
        sheet.first_order_residual_deg_per_h[1] = f64::INFINITY;
        sheet.rate_deg_per_h = [f64::NAN; 3];
        let text = compensation_text(&sheet, 1000);
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        assert!(text.contains("no finite number"), "{text}");
    }
}

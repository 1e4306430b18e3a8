//! The compensation of a run in `summary.json`.

use serde_json::Value;

use crate::report::layout::json::{object, put, put_array};
use crate::signal::CompensationSheet;

/// `compensation` of the summary.
pub(crate) fn compensation_json(sheet: &CompensationSheet) -> Value {
    let mut record = object([
        ("form", sheet.form.into()),
        ("source", sheet.source.as_str().into()),
        ("follows_temperature", sheet.follows_temperature.into()),
    ]);
    for (key, values) in [
        ("bias_deg_per_h", sheet.bias_deg_per_h),
        ("scale_factor_error_ppm", sheet.scale_factor_error_ppm),
        ("rate_deg_per_h", sheet.rate_deg_per_h),
        ("exact_residual_deg_per_h", sheet.exact_residual_deg_per_h),
        (
            "first_order_residual_deg_per_h",
            sheet.first_order_residual_deg_per_h,
        ),
    ] {
        put_array(&mut record, key, &values);
    }
    for (name, angle) in &sheet.theta_arcsec {
        put(&mut record, &format!("theta_{name}_arcsec"), *angle);
    }
    record.into()
}

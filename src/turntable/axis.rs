//! Where the input axis points, and how much of the Earth's rotation it sees.

use crate::scenario::SiteConfig;
use crate::units::{EARTH_RATE_RAD_PER_S, deg_to_rad};

/// Projection of the Earth's rotation on the input axis, rad/s.
///
/// In local north, east, up coordinates the Earth turns at `OmegaE (cos lat, 0, sin lat)` and an
/// axis of elevation `el` and azimuth `az` (from north towards east) points along
/// `(cos el cos az, cos el sin az, sin el)`, so that
/// `Omega = OmegaE (cos lat cos el cos az + sin lat sin el)`.
/// A vertical axis sees `15.0411 sin(lat)` deg/h; a horizontal one pointing east sees nothing.
///
/// # Source
/// Derived from the two vectors above; `OmegaE` is that of WGS 84. Known answer:
/// `known_answer_k28_earth_rate_on_a_vertical_axis`.
#[must_use]
pub fn earth_rate_rad_per_s(site: &SiteConfig) -> f64 {
    let latitude = deg_to_rad(site.latitude_deg);
    let elevation = deg_to_rad(site.axis_elevation_deg);
    let azimuth = deg_to_rad(site.axis_azimuth_deg);
    EARTH_RATE_RAD_PER_S
        * (latitude.cos() * elevation.cos() * azimuth.cos() + latitude.sin() * elevation.sin())
}

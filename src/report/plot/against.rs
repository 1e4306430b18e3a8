//! Allan deviations of a run over those of an earlier one.

use super::drawing::axis::Axis;
use super::drawing::panel::{Legend, Panel, WIDTH};
use super::drawing::picture::{Dash, Picture, Stroke};
use super::drawing::series::{extent, stroke_of};

/// Curves of a channel: averaging time, s, and Allan deviation, deg/h.
pub(in crate::report) struct Overlaid<'a> {
    /// Name of the channel.
    pub(in crate::report) name: &'a str,
    /// Earlier curve; empty if there is none.
    pub(in crate::report) old: &'a [(f64, f64)],
    /// Later curve; empty if there is none.
    pub(in crate::report) new: &'a [(f64, f64)],
}

/// The later curves as lines, the earlier ones wide and pale below them; none without a point.
pub(in crate::report) fn picture(title: &str, channels: &[Overlaid]) -> Option<Picture> {
    let points = || {
        let curves = channels
            .iter()
            .flat_map(|channel| [channel.old, channel.new]);
        curves.flatten().copied()
    };
    let positive = |value: &f64| *value > 0.0;
    let x = extent(points().map(|(tau, _)| tau).filter(positive))?;
    let y = extent(points().map(|(_, deviation)| deviation).filter(positive))?;
    let mut picture = Picture::new(WIDTH, 560.0);
    picture.heading((90.0, 28.0), &format!("{title}: Allan deviation"), 18.0);
    let x = Axis::log(x, 0.01, "averaging time τ [s]");
    let y = Axis::log(y, 0.04, "Allan deviation σ(τ) [deg/h]");
    let panel = Panel::new(&mut picture, (56.0, 500.0), x, y);
    let mut legend = Legend::new(56.0);
    for (index, channel) in channels.iter().enumerate() {
        let own = stroke_of(index);
        let earlier = Stroke {
            width: 5.0,
            dash: Dash::Solid,
            opacity: 0.35,
            ..own
        };
        for (curve, stroke, when) in [(channel.old, earlier, "before"), (channel.new, own, "now")] {
            panel.line(&mut picture, curve, stroke);
            if !curve.is_empty() {
                legend.line(&mut picture, stroke, &format!("{}, {when}", channel.name));
            }
        }
        legend.space();
    }
    Some(picture)
}

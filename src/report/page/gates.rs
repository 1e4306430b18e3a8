//! Gates as intervals against their limits.

use maud::{Markup, html};

use super::document::{by_value, maybe, wide};
use crate::gate::{Verdict, VerdictKind, limits_text, plain, three_digits};
use crate::scenario::portable_place;

/// Size of the picture of a gate, user units.
pub(super) const WIDTH: f64 = 240.0;
const HEIGHT: f64 = 24.0;
/// Free part of the scale on either side.
const MARGIN: f64 = 0.12;

/// A line of user units over some values.
pub(super) struct Scale {
    start: f64,
    span: f64,
    /// Whether all values are one.
    pub(super) is_point: bool,
}

impl Scale {
    /// Over the finite ones of some values; none where there is none.
    pub(super) fn over(values: impl Iterator<Item = f64>) -> Option<Self> {
        let mut finite = values.filter(|value| value.is_finite());
        let first = finite.next()?;
        let (least, most) = finite.fold((first, first), |(least, most), value| {
            (least.min(value), most.max(value))
        });
        let span = match most - least {
            span if span > 0.0 => span,
            _ => first.abs().max(1.0),
        };
        let (start, end) = (least - MARGIN * span, most + MARGIN * span);
        Some(Self {
            start,
            span: end - start,
            is_point: least >= most,
        })
    }

    /// Place of a value.
    pub(super) fn x(&self, at: f64) -> f64 {
        WIDTH * (at - self.start) / self.span
    }

    /// Places of two ends; those of the line where there is no end.
    pub(super) fn between(&self, low: Option<f64>, high: Option<f64>) -> (f64, f64) {
        let finite = |end: Option<f64>| end.filter(|it| it.is_finite());
        let place =
            |end: Option<f64>, otherwise: f64| finite(end).map_or(otherwise, |end| self.x(end));
        (place(low, 0.0), place(high, WIDTH))
    }
}

/// User units as text.
pub(super) fn pixels_text(pixels: f64) -> String {
    format!("{pixels:.1}")
}

/// Word and class of a verdict.
pub(super) fn verdict_word(verdict: &Verdict) -> (&'static str, &'static str) {
    match (verdict.kind, verdict.accepted) {
        (VerdictKind::Pass, _) => ("PASS", "pass"),
        (VerdictKind::Fail, _) => ("FAIL", "fail"),
        (VerdictKind::Inconclusive, true) => ("allowed", "doubt"),
        (VerdictKind::Inconclusive, false) => ("INCONCLUSIVE", "fail"),
    }
}

/// A gate in a table.
pub(super) struct GateRow<'a> {
    /// Link to its run, in a table of several.
    pub(super) run: Option<Markup>,
    /// How it was judged.
    pub(super) verdict: &'a Verdict,
    /// The key that nobody set and that its metric says again.
    pub(super) assumption: Option<&'static str>,
}

/// Gates, as intervals against their limits.
pub(super) fn gates_table(rows: &[GateRow], label: &str) -> Markup {
    let has_run = rows.iter().any(|row| row.run.is_some());
    let table = html! {
        table.sortable {
            thead { tr {
                th scope="col" { "verdict" }
                @if has_run { th scope="col" { "run" } }
                th scope="col" { "gate" }
                th scope="col" { "interval against limits" }
                th.num scope="col" { "value" }
                th.num scope="col" { "limits" }
                th scope="col" { "unit" }
            } }
            tbody { @for GateRow { run, verdict, assumption } in rows { tr {
                @let (word, class) = verdict_word(verdict);
                td { span class={ "pill " (class) } { (word) } }
                @if has_run { td { @if let Some(run) = run { (run) } } }
                th scope="row" {
                    code { (verdict.metric) }
                    @if let Some(of) = &verdict.relative_to { span.soft { " relative to " (of) } }
                    @if let Some(key) = assumption { " " span.pill.doubt title={ "says again what nobody set: " (key) } { "assumed" } }
                    @if !verdict.accepted || verdict.value.is_none() {
                        span.definition { (verdict.reason) @if let Some(place) = &verdict.location { " (" (portable_place(place)) ")" } }
                    }
                }
                td data-v=(distance(verdict).map_or_else(String::new, by_value)) { (maybe(bar(verdict, class))) }
                td.num data-v=(verdict.value.map_or_else(String::new, by_value)) { (interval_text(verdict)) }
                td.num { (limits_text(verdict.min, verdict.max)) }
                td { (unit_word(&verdict.unit)) }
            } } }
        }
    };
    wide(label, &table)
}

/// A unit as tables show it; nothing for a ratio.
pub(super) fn unit_word(unit: &str) -> &str {
    if unit == "1" { "" } else { unit }
}

/// Value and interval.
fn interval_text(verdict: &Verdict) -> String {
    let Some(value) = verdict.value else {
        return "none".to_owned();
    };
    match (verdict.low, verdict.high) {
        (Some(low), Some(high)) if low < high => {
            format!(
                "{} [{}, {}]",
                plain(value),
                three_digits(low),
                three_digits(high)
            )
        }
        _ => plain(value),
    }
}

/// How far inside its limits a gate is, as a part of their size; negative outside. Gates sort by it.
///
/// A limit of zero has no size: the value has then.
fn distance(verdict: &Verdict) -> Option<f64> {
    let value = verdict.value?;
    let scale = |limit: f64| match (verdict.min, verdict.max) {
        (Some(min), Some(max)) if min < max => max - min,
        _ if limit.abs() > 0.0 => limit.abs(),
        _ => value.abs().max(f64::MIN_POSITIVE),
    };
    let inside = [
        verdict.min.map(|min| (value - min) / scale(min)),
        verdict.max.map(|max| (max - value) / scale(max)),
    ];
    inside.into_iter().flatten().reduce(f64::min)
}

/// The interval on a line with the accepted part; nothing without a value.
fn bar(verdict: &Verdict, class: &str) -> Option<Markup> {
    let value = verdict.value.filter(|value| value.is_finite())?;
    let known = [
        Some(value),
        verdict.low,
        verdict.high,
        verdict.min,
        verdict.max,
    ];
    let scale = Scale::over(known.into_iter().flatten())?;
    let x = |at: f64| scale.x(at);
    let zone = scale.between(verdict.min, verdict.max);
    let interval = scale.between(verdict.low, verdict.high);
    let text = pixels_text;
    let middle = HEIGHT / 2.0;
    let label = format!(
        "{} against {} {}",
        interval_text(verdict),
        limits_text(verdict.min, verdict.max),
        unit_word(&verdict.unit)
    );
    Some(html! {
        svg class={ "bar " (class) } viewBox=(format!("0 0 {WIDTH} {HEIGHT}")) role="img" aria-label=(label.trim_end()) {
            title { (label.trim_end()) }
            rect.zone x=(text(zone.0)) y="4" width=(text((zone.1 - zone.0).max(1.0))) height=(text(HEIGHT - 8.0)) {}
            line.base x1="0" x2=(WIDTH) y1=(middle) y2=(middle) {}
            @for limit in [verdict.min, verdict.max].into_iter().flatten() {
                line.limit x1=(text(x(limit))) x2=(text(x(limit))) y1="2" y2=(text(HEIGHT - 2.0)) {}
            }
            line.interval x1=(text(interval.0)) x2=(text(interval.1)) y1=(middle) y2=(middle) {}
            @for end in [verdict.low, verdict.high].into_iter().flatten() {
                line.interval x1=(text(x(end))) x2=(text(x(end))) y1="7" y2=(text(HEIGHT - 7.0)) {}
            }
            circle.value cx=(text(x(value))) cy=(middle) r="3" {}
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_distance_is_a_number_that_sorts() {
        let of = |value: f64, min: Option<f64>, max: Option<f64>| {
            distance(&Verdict {
                metric: "raw.mean_deg_per_h".to_owned(),
                kind: VerdictKind::Fail,
                accepted: false,
                value: Some(value),
                low: None,
                high: None,
                min,
                max,
                unit: "deg/h".to_owned(),
                relative_to: None,
                reason: String::new(),
                location: None,
            })
        };
        assert_eq!(of(1299.0, None, Some(0.0)), Some(-1.0));
        assert_eq!(of(0.0, None, Some(0.0)), Some(0.0));
        assert_eq!(of(2.0, Some(0.0), None), Some(1.0));
        assert_eq!(of(3.0, Some(3.0), Some(3.0)), Some(0.0));
        assert_eq!(of(1.5, Some(1.0), Some(2.0)), Some(0.5));
        assert_eq!(
            of(1e300, None, Some(1e-300)).map(by_value),
            Some(String::new())
        );
    }
}

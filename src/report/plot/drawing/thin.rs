//! Lines with fewer points that look the same.

use super::picture::Point;

/// The points of a line that keep it within a distance of where it was, pixels; both ends stay.
///
/// # Source
/// Douglas and Peucker, Cartographica 10 (1973) 112, with a stack in place of the recursion.
pub(in crate::report::plot) fn thinned(points: &[Point], tolerance: f64) -> Vec<Point> {
    let Some(last) = points.len().checked_sub(1) else {
        return Vec::new();
    };
    let mut is_kept = vec![false; points.len()];
    (is_kept[0], is_kept[last]) = (true, true);
    let mut open = vec![(0, last)];
    while let Some((start, end)) = open.pop() {
        let inner =
            (start + 1..end).map(|at| (at, distance(points[at], points[start], points[end])));
        let farthest = inner.max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((at, _)) = farthest.filter(|(_, distance)| *distance > tolerance) {
            is_kept[at] = true;
            open.extend([(start, at), (at, end)]);
        }
    }
    let kept = points.iter().zip(is_kept).filter(|(_, is_kept)| *is_kept);
    kept.map(|(point, _)| *point).collect()
}

/// Distance of a point from the segment between two others.
fn distance((x, y): Point, (x0, y0): Point, (x1, y1): Point) -> f64 {
    let (dx, dy) = (x1 - x0, y1 - y0);
    let square = dx * dx + dy * dy;
    let along = if square > 0.0 {
        (((x - x0) * dx + (y - y0) * dy) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (x - x0 - along * dx).hypot(y - y0 - along * dy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thinned_line_stays_within_the_distance_asked_for() {
        let curve: Vec<Point> = (0..2000)
            .map(|at| {
                let x = 0.4 * f64::from(at);
                (
                    x,
                    100.0 * (0.01 * x).sin() + if at == 777 { 30.0 } else { 0.0 },
                )
            })
            .collect();
        let thin = thinned(&curve, 0.25);
        assert!(thin.len() < 100, "{} points", thin.len());
        assert!(thin.contains(&curve[777]), "a spike is no detail");
        let farthest = curve.iter().map(|point| {
            let pairs = thin.windows(2).map(|two| distance(*point, two[0], two[1]));
            pairs.fold(f64::INFINITY, f64::min)
        });
        assert!(farthest.fold(0.0, f64::max) <= 0.25);
        assert_eq!((thin[0], thin[thin.len() - 1]), (curve[0], curve[1999]));
    }

    #[test]
    fn nothing_and_closed_lines_are_thinned_too() {
        assert!(thinned(&[], 1.0).is_empty());
        let square = [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0), (0.0, 0.0)];
        assert_eq!(thinned(&square, 1.0), square);
    }
}

//! Labels beside points that give way to one another.

use super::panel::{LEFT, RIGHT};
use super::picture::{Anchor, BLACK, Picture, Point, Stroke, text_width};

/// Size of the labels, pixels.
const SIZE: f64 = 12.5;
/// Half the side of what a marker covers.
const MARKER: f64 = 7.0;
/// Directions in which a label may stand, and how far off at most, in steps.
const DIRECTIONS: [(f64, f64); 6] = [
    (1.0, -1.0),
    (1.0, 1.0),
    (-1.0, -1.0),
    (-1.0, 1.0),
    (0.0, -1.0),
    (0.0, 1.0),
];
const STEPS_MAX: u8 = 8;

/// A box: left, top, right, bottom.
type Cover = [f64; 4];

/// What is covered so far.
#[derive(Debug, Default)]
pub(in crate::report::plot) struct Labels {
    covered: Vec<Cover>,
}

impl Labels {
    /// Keeps labels off a marker.
    pub(in crate::report::plot) fn keep_clear(&mut self, (x, y): Point) {
        let cover = [x - MARKER, y - MARKER, x + MARKER, y + MARKER];
        self.covered.push(cover);
    }

    /// Writes a label as near to a point as nothing stands; one that had to go further off is joined to its
    /// point by a line. Where there is no free place it covers as little as it can.
    pub(in crate::report::plot) fn place(
        &mut self,
        picture: &mut Picture,
        point: Point,
        text: &str,
    ) {
        let width = text_width(text, SIZE);
        let steps = (1..=STEPS_MAX).flat_map(|step| DIRECTIONS.map(|to| (f64::from(step), to)));
        let mut best: Option<(f64, Point, Cover, f64)> = None;
        for (step, (right, down)) in steps {
            let middle_y = point.1 + down * (11.0 + 15.0 * (step - 1.0));
            let left = match right {
                right if right > 0.0 => point.0 + 9.0,
                right if right < 0.0 => point.0 - 9.0 - width,
                _ => point.0 - width / 2.0,
            };
            let cover = [
                left,
                middle_y - SIZE / 2.0,
                left + width,
                middle_y + SIZE / 2.0,
            ];
            if left < LEFT + 2.0 || left + width > RIGHT - 2.0 {
                continue;
            }
            let hidden: f64 = self.covered.iter().map(|other| common(&cover, other)).sum();
            if best.as_ref().is_none_or(|(least, ..)| hidden < *least) {
                best = Some((hidden, (left, middle_y), cover, step));
            }
            if hidden <= 0.0 {
                break;
            }
        }
        let beside = (point.0 + 9.0, point.1 - 11.0);
        let (at, cover, step) = match best {
            Some((_, at, cover, step)) => (at, cover, step),
            None => (
                beside,
                [beside.0, beside.1, beside.0 + width, beside.1],
                1.0,
            ),
        };
        // Fonts differ in width: the end that is nearer to the point is the one that keeps its place.
        let (x, anchor) = if cover[2] < point.0 {
            (cover[2], Anchor::End)
        } else {
            (at.0, Anchor::Start)
        };
        if step > 1.0 {
            let end = (point.0.clamp(cover[0], cover[2]), at.1);
            picture.line(vec![point, end], Stroke::solid(BLACK, 0.5));
        }
        picture.text((x, at.1), text, SIZE, anchor);
        self.covered.push(cover);
    }
}

/// Area that two boxes have in common.
fn common(one: &Cover, other: &Cover) -> f64 {
    let width = one[2].min(other[2]) - one[0].max(other[0]);
    let height = one[3].min(other[3]) - one[1].max(other[1]);
    width.max(0.0) * height.max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plot::drawing::panel::WIDTH;

    #[test]
    fn labels_of_points_in_one_place_cover_neither_each_other_nor_a_marker() {
        let mut picture = Picture::new(WIDTH, 600.0);
        let mut labels = Labels::default();
        let points: Vec<Point> = (0..6)
            .map(|it| (400.0 + 3.0 * f64::from(it), 300.0))
            .collect();
        for point in &points {
            labels.keep_clear(*point);
        }
        for point in &points {
            labels.place(&mut picture, *point, "moving-average 1.00");
        }
        assert_eq!(labels.covered.len(), 12);
        for (index, label) in labels.covered.iter().enumerate().skip(6) {
            for other in &labels.covered[..index] {
                assert!(common(label, other) <= 0.0, "{label:?} {other:?}");
            }
        }
    }
}

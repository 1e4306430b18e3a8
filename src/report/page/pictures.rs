//! Pictures within a page, as many as it has room for.

use maud::{Markup, PreEscaped, html};

/// A picture of a run or a suite.
#[derive(Clone, Copy, Debug)]
pub(in crate::report) struct Shown<'a> {
    /// Name of its file beside the page.
    pub(in crate::report) name: &'a str,
    /// What it shows.
    pub(in crate::report) holds: &'a str,
    /// Its text.
    pub(in crate::report) svg: &'a str,
}

/// The pictures that fit into `room` bytes, in their order, which is less by them then; the others are
/// named.
pub(super) fn pictures(all: &[Shown], room: &mut usize) -> Markup {
    const FRAME_BYTES: usize = 500;
    let mut fits = |picture: &Shown| {
        let bytes = picture.svg.len() + FRAME_BYTES;
        let fits = bytes <= *room;
        *room -= if fits { bytes } else { 0 };
        fits
    };
    html! {
        @for picture in all {
            @if fits(picture) { (figure(picture)) }
            @else {
                p.soft { "Not in this file, for its size: " a href=(picture.name) { (picture.name) } ", " (picture.holds) "." }
            }
        }
    }
}

fn figure(picture: &Shown) -> Markup {
    let name =
        html! { (capital(picture.holds)) " " a.small href=(picture.name) { (picture.name) } };
    framed(&name, (picture.holds, picture.name), picture.svg)
}

/// A picture that stands in no file of its own.
pub(super) fn figure_of_page(holds: &str, title: &str, svg: &str) -> Markup {
    framed(
        &html! { (capital(holds)) ": " (title) },
        (holds, title),
        svg,
    )
}

fn framed(caption: &Markup, (holds, name): (&str, &str), svg: &str) -> Markup {
    // Within a page the picture takes the width of its column.
    let label = format!("<svg role=\"img\" aria-label=\"{holds}\" ");
    let svg = svg.replacen("<svg ", &label, 1);
    html! {
        figure.picture {
            figcaption {
                span { (caption) }
                output.small {}
            }
            div.frame role="group" aria-label=(name) tabindex="0" { (PreEscaped(svg)) }
        }
    }
}

/// A sentence's beginning.
pub(super) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|first| first.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

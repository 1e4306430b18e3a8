//! Figures in the prose of the pages: each stands in what a command printed, or in a scenario.

use super::Page;
use super::console::{Use, blocks};

/// Decimal numbers of a text, without sign and exponent; versions (`0.1.0`) are none.
fn decimals(text: &str) -> Vec<&str> {
    let is_part = |c: char| c.is_ascii_digit() || c == '.';
    text.split(|c| !is_part(c))
        .map(|token| token.trim_matches('.'))
        .filter(|token| token.split('.').count() == 2 && token.split('.').all(|p| !p.is_empty()))
        .collect()
}

/// Prose of a page: no fenced blocks, no code, no targets of links.
fn prose(text: &str) -> String {
    let mut kept = String::new();
    let mut is_code = false;
    for line in text.lines() {
        if line.starts_with("```") {
            is_code = !is_code;
            continue;
        }
        if is_code {
            continue;
        }
        for (index, part) in line.split('`').enumerate() {
            if index % 2 == 0 {
                kept.push_str(part);
            }
            kept.push(' ');
        }
        kept.push('\n');
    }
    kept
}

/// Whether `printed`, rounded to the places of `figure`, is `figure`.
fn rounds_to(printed: &str, figure: &str) -> bool {
    let places = figure.split('.').nth(1).map_or(0, str::len);
    let value: f64 = printed.parse().expect("a decimal number");
    format!("{value:.places$}") == figure
}

/// Figures of the prose of a page that neither its blocks nor `inputs`, the scenarios, hold.
pub(super) fn unfounded(page: &Page, inputs: &str) -> Vec<String> {
    let blocks = blocks(&page.text);
    let printed: Vec<&str> = blocks
        .iter()
        .filter(|block| matches!(block.purpose, Use::Commands | Use::Excerpt(_)))
        .flat_map(|block| &block.lines)
        .flat_map(|line| decimals(line))
        .collect();
    let given = decimals(inputs);
    decimals(&prose(&page.text))
        .into_iter()
        .filter(|figure| !given.contains(figure))
        .filter(|figure| !printed.iter().any(|number| rounds_to(number, figure)))
        .map(|figure| format!("{}: {figure}", page.name))
        .collect()
}

#[test]
fn a_figure_that_nothing_prints_is_found() {
    let page = |prose: &str| Page {
        name: "page.md".to_owned(),
        text: format!("{prose}\n```console\n$ fogbench list\n0.49029 \u{b1}0.002\n```\n"),
    };
    let sound = "A gain of 0.490 at 2.5 Hz, version 0.1.0, `code 7.77`.";
    assert!(unfounded(&page(sound), "rate = 2.5").is_empty());
    assert_eq!(
        unfounded(&page("A gain of 0.51."), "rate = 2.5"),
        ["page.md: 0.51"]
    );
}

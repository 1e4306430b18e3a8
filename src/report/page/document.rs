//! One HTML file that stands alone: style and script within, nothing asked of anyone.

use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");
/// Nothing is fetched from anywhere: style and script stand in the file.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; \
     img-src data:; base-uri 'none'; form-action 'none'";

/// The file of a title, a head and the sections.
pub(super) fn document(title: &str, head: &Markup, sections: &Markup, foot: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="generator" content="fogbench";
                // An icon of its own keeps browsers from asking for one.
                link rel="icon" href="data:,";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header { (head) }
                main { (sections) }
                footer { (foot) }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    page.into_string() + "\n"
}

/// A section under a heading that the list of contents leads to.
pub(super) fn section(id: &str, heading: &str, body: &Markup) -> Markup {
    html! {
        section id=(id) aria-labelledby=(format!("{id}-heading")) {
            h2 id=(format!("{id}-heading")) { (heading) }
            (body)
        }
    }
}

/// A table that scrolls sideways where it is too wide.
pub(super) fn wide(label: &str, table: &Markup) -> Markup {
    html! { div.scroll role="region" aria-label=(label) tabindex="0" { (table) } }
}

/// The field that filters a table, shown by the script.
pub(super) fn filter(table: &str, what: &str) -> Markup {
    html! {
        div.tools data-of=(table) hidden {
            label { "Filter " input type="search" placeholder=(what) autocomplete="off"; }
            output.soft aria-live="polite" {}
        }
    }
}

/// A value that a table sorts by; empty, and last, where it is no number.
pub(super) fn by_value(value: f64) -> String {
    if value.is_finite() {
        value.to_string()
    } else {
        String::new()
    }
}

/// What there is, or nothing.
pub(super) fn maybe(markup: Option<Markup>) -> Markup {
    markup.unwrap_or_else(|| html! {})
}

/// Pairs of a name and a text.
pub(super) fn facts(pairs: &[(&str, String)]) -> Markup {
    html! {
        dl.facts {
            @for (name, text) in pairs { div { dt { (name) } dd { (text) } } }
        }
    }
}

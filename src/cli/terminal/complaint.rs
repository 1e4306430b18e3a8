//! Complaints about scenarios: one line that says all, then the text that it is about.

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

use crate::cli::terminal::output;
use crate::experiment::CalibrateError;
use crate::scenario::{ScenarioError, bounded};

/// Something to complain of.
pub(in crate::cli) trait Complaint {
    /// What is printed of it.
    fn shown(&self, is_coloured: bool) -> String;
}

impl Complaint for String {
    fn shown(&self, _is_coloured: bool) -> String {
        format!("error: {}", bounded(self))
    }
}

impl Complaint for ScenarioError {
    /// `error: file:line:column: message`, the line and a mark under what is wrong.
    fn shown(&self, is_coloured: bool) -> String {
        let text = self.to_string();
        let title = Level::ERROR.primary_title(bounded(&text));
        let renderer = if is_coloured {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        match self.source() {
            Some((source, line, span)) => {
                let mark = AnnotationKind::Primary.span(span);
                let snippet = Snippet::source(source).line_start(line).annotation(mark);
                renderer.render(&[title.element(snippet)])
            }
            None => renderer.render(&[Group::with_title(title)]),
        }
    }
}

impl Complaint for CalibrateError {
    fn shown(&self, is_coloured: bool) -> String {
        match self {
            Self::Scenario(error) => error.shown(is_coloured),
            other => format!("error: {}", bounded(&other.to_string())),
        }
    }
}

/// Prints complaints to stderr, in colours where that is a terminal: the first of them, and how many
/// more there are.
pub(in crate::cli) fn print<C: Complaint>(errors: &[C]) {
    let is_coloured = output::talk_colour();
    output::talk_first_as(errors.iter(), |error| error.shown(is_coloured));
}

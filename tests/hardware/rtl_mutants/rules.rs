//! The rules by which mutants of Verilog are made: every place of a file, one change each.

use std::collections::BTreeSet;
use std::ops::Range;

use super::tokens::{Form, Source};

/// What a mutant changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Kind {
    Arithmetic,
    Comparison,
    Logic,
    Constant,
    Condition,
    Assignment,
    Reset,
    State,
    Operands,
    Slice,
    Handshake,
}

impl Kind {
    /// All of them, in the order of the table, with what each does.
    pub(super) const ALL: [(Self, &'static str); 11] = [
        (Self::Arithmetic, "+ - * / << >> exchanged"),
        (Self::Comparison, "< <= == != exchanged"),
        (Self::Logic, "& && | || ^ exchanged, ~ ! left out"),
        (Self::Constant, "a constant off by one"),
        (Self::Condition, "a condition negated"),
        (Self::Assignment, "an assignment left out"),
        (Self::Reset, "a reset, or what it sets, left out"),
        (Self::State, "a transition to another state"),
        (Self::Operands, "operands in the other order"),
        (Self::Slice, "a width or slice off by one"),
        (Self::Handshake, "a handshake stuck or inverted"),
    ];
}

/// One change of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Mutant {
    pub(super) kind: Kind,
    /// Line in which the change begins, from 1.
    pub(super) line: usize,
    /// Its lines before and after, blanks drawn together.
    pub(super) before: String,
    pub(super) after: String,
    place: Range<usize>,
    with: String,
}

impl Mutant {
    fn new(kind: Kind, text: &str, place: Range<usize>, with: String) -> Self {
        let first = text[..place.start].rfind('\n').map_or(0, |at| at + 1);
        let last = text[place.end..].find('\n');
        let last = last.map_or(text.len(), |at| place.end + at);
        let drawn_together = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        Self {
            kind,
            line: text[..place.start].matches('\n').count() + 1,
            before: drawn_together(&text[first..last]),
            after: drawn_together(&format!(
                "{}{with}{}",
                &text[first..place.start],
                &text[place.end..last]
            )),
            place,
            with,
        }
    }

    /// The file with the change.
    pub(super) fn text(&self, original: &str) -> String {
        let (start, end) = (self.place.start, self.place.end);
        format!("{}{}{}", &original[..start], self.with, &original[end..])
    }
}

/// Every mutant of a file, each text once.
pub(super) fn mutants(text: &str) -> Vec<Mutant> {
    let source = Source::new(text);
    let states = states(&source);
    let resets = reset_branches(&source);
    let mut found = Vec::new();
    for k in 0..source.tokens.len() {
        if is_default(&source, k) || is_padding(&source, k) || is_unused(&source, k) {
            continue;
        }
        let in_brackets = source.around(k).is_some_and(|open| {
            source.at(open) == "[" || source.around(open).is_some_and(|o| source.at(o) == "[")
        });
        if source.at(k) == "[" {
            slices(&source, k, &mut found);
        }
        if in_brackets {
            continue;
        }
        operators(&source, k, &mut found);
        operands(&source, k, &mut found);
        constants(&source, k, &mut found);
        conditions(&source, k, &mut found);
        assignments(&source, k, &resets, &mut found);
        reset_names(&source, k, &mut found);
        transitions(&source, k, &states, &mut found);
        handshakes(&source, k, &mut found);
    }
    let mut seen = BTreeSet::new();
    found.retain(|(_, place, with)| {
        let is_new = seen.insert((place.start, place.end, with.clone()));
        is_new && *with != text[place.clone()]
    });
    let mutants = found.into_iter();
    mutants
        .map(|(kind, place, with)| Mutant::new(kind, text, place, with))
        .collect()
}

/// Changes that were found: kind, place, what stands there instead.
type Found = Vec<(Kind, Range<usize>, String)>;

/// Whether a token belongs to the default of a parameter, which every instance overrides. Derived
/// parameters, which none does, are marked in their comments.
fn is_default(source: &Source<'_>, k: usize) -> bool {
    let place = source.tokens[k].place.start;
    let start = source.text[..place].rfind('\n').map_or(0, |at| at + 1);
    let line = source.text[start..].lines().next().unwrap_or_default();
    line.trim_start().starts_with("parameter") && !line.contains("(derived)")
}

/// Whether a token counts the zeros above a word: of too few Verilog adds what is missing, and cuts off
/// what is too many.
fn is_padding(source: &Source<'_>, k: usize) -> bool {
    let zeros = |open: usize| {
        let count = source.at(open) == "{" && source.at(open + 1) == "(";
        let close = if count {
            source.partner(open + 1)
        } else {
            open
        };
        let is_zero = count && source.at(close + 1) == "{" && source.at(close + 2) == "1'b0";
        is_zero
            && k < close
            && matches!(
                source.before(open),
                "{" | "+" | "=" | "==" | "!=" | "?" | ":"
            )
    };
    let mut around = source.around(k);
    while let Some(open) = around {
        if zeros(open) {
            return true;
        }
        around = source.around(open);
    }
    false
}

/// Whether a token stands in the declaration of a word that is named as one that nothing reads.
fn is_unused(source: &Source<'_>, k: usize) -> bool {
    let mut start = k;
    while !matches!(source.before(start), "" | ";" | "begin" | "end") {
        start -= 1;
    }
    let end = source.end_of(start, &["=", ";"]);
    source.at(start) == "wire" && source.before(end) == "unused"
}

/// Whether a value is zero in all of its bits.
fn is_zero(value: &str) -> bool {
    value.ends_with("{1'b0}}") && value.matches('{').count() == 2
}

/// Names of the states: constants of a size that are declared together.
fn states<'a>(source: &Source<'a>) -> Vec<&'a str> {
    let mut names = Vec::new();
    for k in 1..source.tokens.len() {
        let is_state = source.is(k - 1, Form::Word)
            && source.at(k) == "="
            && source.at(k + 1).contains("'d")
            && matches!(source.at(k + 2), "," | ";");
        let statement = (0..k).rev().find(|before| source.at(*before) == ";");
        if is_state && statement.is_some_and(|end| source.at(end + 1) == "localparam") {
            names.push(source.at(k - 1));
        }
    }
    names
}

/// Whether a name is that of a reset.
fn is_reset(name: &str) -> bool {
    matches!(name, "rst" | "aresetn")
}

/// Token ranges of the statements that a reset runs.
fn reset_branches(source: &Source<'_>) -> Vec<Range<usize>> {
    let mut branches = Vec::new();
    for k in 0..source.tokens.len() {
        if source.at(k) != "if" {
            continue;
        }
        let close = source.partner(k + 1);
        if !(k..close).any(|inner| is_reset(source.at(inner))) {
            continue;
        }
        let end = if source.at(close + 1) == "begin" {
            (close..source.tokens.len()).find(|end| source.at(*end) == "end")
        } else {
            Some(source.end_of(close + 1, &[";"]))
        };
        branches.push(close + 1..end.unwrap_or(close + 1));
    }
    branches
}

/// Whether a sign has an operand on its left.
fn is_binary(source: &Source<'_>, k: usize) -> bool {
    let before = source.before(k);
    let is_operand = k > 0 && !source.is(k - 1, Form::Sign) && !is_keyword(before);
    is_operand || matches!(before, ")" | "]" | "}")
}

fn is_keyword(word: &str) -> bool {
    matches!(
        word,
        "begin" | "end" | "else" | "if" | "assign" | "case" | "wire" | "reg" | "default"
    )
}

/// First token of the left side, if token `k` is the sign of an assignment.
fn assigned(source: &Source<'_>, k: usize) -> Option<usize> {
    if !matches!(source.at(k), "<=" | "=") || source.is_inside(k) {
        return None;
    }
    let first = source.operand_before(k)?;
    let before = source.before(first);
    let is_statement = matches!(before, "begin" | "end" | "else" | ";" | ")" | ":");
    // A declaration with a value has a width before its name, or none.
    let is_value = matches!(before, "assign" | "wire") || (before == "]" && source.at(k) == "=");
    (is_statement || is_value).then_some(first)
}

/// Whether the assignment whose left side begins with token `first` is a statement.
fn is_statement(source: &Source<'_>, first: usize) -> bool {
    matches!(
        source.before(first),
        "begin" | "end" | "else" | ";" | ")" | ":"
    )
}

fn operators(source: &Source<'_>, k: usize, found: &mut Found) {
    let sign = source.at(k);
    let place = source.place(k, k);
    if matches!(sign, "~" | "!") && !is_binary(source, k) {
        found.push((Kind::Logic, place, String::new()));
        return;
    }
    if !is_binary(source, k) || assigned(source, k).is_some() {
        return;
    }
    let (kind, with) = match sign {
        "+" => (Kind::Arithmetic, "-"),
        "-" => (Kind::Arithmetic, "+"),
        "*" if source.before(k) != "@" => (Kind::Arithmetic, "+"),
        "/" => (Kind::Arithmetic, "*"),
        "<<" => (Kind::Arithmetic, ">>"),
        ">>" => (Kind::Arithmetic, "<<"),
        "<<<" => (Kind::Arithmetic, ">>>"),
        ">>>" => (Kind::Arithmetic, "<<<"),
        "==" => (Kind::Comparison, "!="),
        "!=" => (Kind::Comparison, "=="),
        "<" => (Kind::Comparison, "<="),
        "<=" => (Kind::Comparison, "<"),
        ">" => (Kind::Comparison, ">="),
        ">=" => (Kind::Comparison, ">"),
        "&&" => (Kind::Logic, "||"),
        "||" => (Kind::Logic, "&&"),
        "&" => (Kind::Logic, "|"),
        "|" => (Kind::Logic, "&"),
        "^" => (Kind::Logic, "|"),
        _ => return,
    };
    found.push((kind, place, with.to_owned()));
}

fn operands(source: &Source<'_>, k: usize, found: &mut Found) {
    let is_ordered = matches!(
        source.at(k),
        "-" | "/" | "<<" | ">>" | "<<<" | ">>>" | "<" | ">" | "<=" | ">="
    );
    if !is_ordered || !is_binary(source, k) || assigned(source, k).is_some() {
        return;
    }
    let (Some(first), Some(last)) = (source.operand_before(k), source.operand_after(k)) else {
        return;
    };
    let (left, right) = (source.of(first, k - 1), source.of(k + 1, last));
    let with = format!("{right} {} {left}", source.at(k));
    found.push((Kind::Operands, source.place(first, last), with));
}

fn constants(source: &Source<'_>, k: usize, found: &mut Found) {
    if !source.is(k, Form::Number) {
        return;
    }
    if let Some(with) = off_by_one(source.at(k)) {
        found.push((Kind::Constant, source.place(k, k), with));
    }
}

/// The next number of that size, or the one before where there is none; of a plain count the one before,
/// as more than enough bits, words or clocks would be no fault.
fn off_by_one(number: &str) -> Option<String> {
    let Some((size, digits)) = number.split_once('\'') else {
        let value = number.parse::<u64>().ok()?;
        return Some(value.checked_sub(1).unwrap_or(1).to_string());
    };
    let bits: u32 = size.parse().ok()?;
    let digits_at = digits.find(|c: char| !matches!(c, 's' | 'd' | 'h' | 'b'))?;
    // The last letter of the base may be a digit, as in 8'hb0; the base is one letter, or two with s.
    let base_length = if digits.starts_with('s') { 2 } else { 1 };
    let (base, digits) = digits.split_at(base_length.min(digits_at));
    let radix = match base.chars().last()? {
        'h' => 16,
        'b' => 2,
        _ => 10,
    };
    let value = u128::from_str_radix(digits, radix).ok()?;
    let most = u128::MAX >> (128 - bits);
    let other = if value >= most { value - 1 } else { value + 1 };
    Some(match radix {
        16 => format!("{size}'{base}{other:0width$x}", width = digits.len()),
        2 => format!("{size}'{base}{other:b}"),
        _ => format!("{size}'{base}{other}"),
    })
}

fn conditions(source: &Source<'_>, k: usize, found: &mut Found) {
    if source.at(k) == "if" {
        let close = source.partner(k + 1);
        let with = format!("(!{})", source.of(k + 1, close));
        found.push((Kind::Condition, source.place(k + 1, close), with));
    }
    if source.at(k) == "?" {
        let mut nested = 0;
        let mut colon = k + 1;
        loop {
            colon = source.end_of(colon, &["?", ":"]);
            match source.at(colon) {
                "?" => nested += 1,
                ":" if nested > 0 => nested -= 1,
                _ => break,
            }
            colon += 1;
        }
        let end = source.end_of(colon + 1, &[";", ","]);
        let (first, second) = (source.of(k + 1, colon - 1), source.of(colon + 1, end - 1));
        let with = format!("({second}) : ({first})");
        found.push((Kind::Condition, source.place(k + 1, end - 1), with));
    }
}

fn assignments(source: &Source<'_>, k: usize, resets: &[Range<usize>], found: &mut Found) {
    let Some(first) = assigned(source, k).filter(|first| is_statement(source, *first)) else {
        return;
    };
    let end = source.end_of(k + 1, &[";"]);
    let is_of_reset = resets.iter().any(|branch| branch.contains(&k));
    let kind = if is_of_reset {
        Kind::Reset
    } else {
        Kind::Assignment
    };
    // The semicolon stays: a statement that does nothing.
    found.push((kind, source.place(first, end - 1), String::new()));
}

fn reset_names(source: &Source<'_>, k: usize, found: &mut Found) {
    let is_use = is_reset(source.at(k)) && !matches!(source.before(k), "." | "wire");
    if is_use && source.at(k + 1) != "=" {
        let never = if source.at(k) == "rst" {
            "1'b0"
        } else {
            "1'b1"
        };
        found.push((Kind::Reset, source.place(k, k), never.to_owned()));
    }
}

fn transitions(source: &Source<'_>, k: usize, states: &[&str], found: &mut Found) {
    let is_of_state = assigned(source, k).is_some_and(|first| source.at(first) == "state");
    if !is_of_state {
        return;
    }
    for target in k + 1..source.end_of(k + 1, &[";"]) {
        let named = states.iter().position(|state| *state == source.at(target));
        if let Some(position) = named {
            let next = states[(position + 1) % states.len()].to_owned();
            found.push((Kind::State, source.place(target, target), next));
        }
    }
}

fn slices(source: &Source<'_>, k: usize, found: &mut Found) {
    let close = source.partner(k);
    let colon = source.end_of(k + 1, &[":", "+:", "-:"]);
    // Exact values have bits to spare, and a constant holds its value whatever its width.
    let is_of_constant = source.before(k) == "localparam";
    if is_of_constant || (source.at(k + 1) == "AW" && source.at(colon + 1) == "0") {
        return;
    }
    match source.at(colon) {
        ":" => {
            let (high, low) = (source.of(k + 1, colon - 1), source.of(colon + 1, close - 1));
            let with = format!("[({high})-1:{low}]");
            found.push((Kind::Slice, source.place(k, close), with));
            if low != "0" {
                let with = format!("[{high}:({low})+1]");
                found.push((Kind::Slice, source.place(k, close), with));
            }
        }
        "]" if close == k + 2 => {
            if let Ok(index) = source.at(k + 1).parse::<u32>() {
                let other = index.checked_sub(1).unwrap_or(1);
                found.push((Kind::Slice, source.place(k, close), format!("[{other}]")));
            }
        }
        _ => {}
    }
}

/// Parts of the names of signals that say when a word is there, is taken, or has to wait.
const HANDSHAKES: [&str; 8] = [
    "valid", "ready", "done", "req", "take", "given", "handed", "stall",
];

fn handshakes(source: &Source<'_>, k: usize, found: &mut Found) {
    let is_handshake = |name: &str| HANDSHAKES.iter().any(|part| name.contains(part));
    let value = if let Some(first) = assigned(source, k) {
        let end = source.end_of(k + 1, &[";", ","]);
        is_handshake(source.at(first)).then(|| (k + 1, end - 1))
    } else if source.at(k) == "." && source.at(k + 2) == "(" {
        let close = source.partner(k + 2);
        (is_handshake(source.at(k + 1)) && close > k + 3).then(|| (k + 3, close - 1))
    } else {
        None
    };
    if let Some((first, last)) = value {
        let inverted = format!("~({})", source.of(first, last));
        for with in ["1'b0".to_owned(), "1'b1".to_owned(), inverted] {
            if with == "1'b0" && is_zero(source.of(first, last)) {
                continue;
            }
            found.push((Kind::Handshake, source.place(first, last), with));
        }
    }
}

#[test]
fn numbers_off_by_one_keep_their_size_and_base() {
    for (number, wanted) in [
        ("7", "6"),
        ("0", "1"),
        ("1'b0", "1'b1"),
        ("1'b1", "1'b0"),
        ("4'd14", "4'd15"),
        ("4'd15", "4'd14"),
        ("64'h3ff0", "64'h3ff1"),
        ("8'hb0", "8'hb1"),
        ("128'sh00ff", "128'sh0100"),
    ] {
        assert_eq!(off_by_one(number).as_deref(), Some(wanted), "{number}");
    }
}

#[test]
fn every_rule_makes_its_mutants() {
    let text = "module m;\n    localparam [1:0] A = 2'd0, B = 2'd1;\n    wire ready = x & ~y;\n    \
                always @(posedge clk)\n        if (rst) state <= A;\n        \
                else state <= a - b < c[3:1] ? B : A;\nendmodule\n";
    let all = mutants(text);
    let has = |kind: Kind, after: &str| {
        let found = all
            .iter()
            .any(|mutant| mutant.kind == kind && mutant.after == after);
        assert!(found, "{kind:?}: no {after} in {all:#?}");
    };
    has(Kind::Arithmetic, "else state <= a + b < c[3:1] ? B : A;");
    has(Kind::Comparison, "else state <= a - b <= c[3:1] ? B : A;");
    has(Kind::Logic, "wire ready = x | ~y;");
    has(Kind::Logic, "wire ready = x & y;");
    has(Kind::Constant, "localparam [1:0] A = 2'd0, B = 2'd2;");
    has(Kind::Condition, "if (!(rst)) state <= A;");
    has(Kind::Condition, "else state <= a - b < c[3:1] ? (A) : (B);");
    has(Kind::Assignment, "else ;");
    has(Kind::Reset, "if (rst) ;");
    has(Kind::Reset, "if (1'b0) state <= A;");
    has(Kind::State, "if (rst) state <= B;");
    has(Kind::Operands, "else state <= b - a < c[3:1] ? B : A;");
    has(Kind::Slice, "else state <= a - b < c[(3)-1:1] ? B : A;");
    has(Kind::Slice, "else state <= a - b < c[3:(1)+1] ? B : A;");
    has(Kind::Handshake, "wire ready = ~(x & ~y);");
    for (kind, _) in Kind::ALL {
        assert!(all.iter().any(|mutant| mutant.kind == kind), "{kind:?}");
    }
}

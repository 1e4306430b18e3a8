//! Words, numbers and signs of a Verilog file, without comments, directives and what is for waveforms.

use std::ops::Range;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// A name or a keyword.
    Word,
    /// A number, sized or not.
    Number,
    /// An operator or a bracket.
    Sign,
}

/// A token and its place in the text.
#[derive(Clone, Debug)]
pub(super) struct Token {
    pub(super) form: Form,
    pub(super) place: Range<usize>,
}

/// Signs of more than one character, longest first.
const LONG_SIGNS: [&str; 17] = [
    "<<<", ">>>", "===", "!==", "<<", ">>", "<=", ">=", "==", "!=", "&&", "||", "+:", "-:", "~|",
    "~&", "~^",
];

/// A file taken apart.
#[derive(Debug)]
pub(super) struct Source<'a> {
    pub(super) text: &'a str,
    pub(super) tokens: Vec<Token>,
    /// Partner of each bracket; for other tokens their own number.
    partners: Vec<usize>,
    /// Brackets that are open at each token.
    depths: Vec<usize>,
}

impl<'a> Source<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        let tokens = tokens(text);
        let mut partners: Vec<usize> = (0..tokens.len()).collect();
        let mut depths = vec![0; tokens.len()];
        let mut open = Vec::new();
        for (k, token) in tokens.iter().enumerate() {
            let sign = &text[token.place.clone()];
            if matches!(sign, ")" | "]" | "}") {
                let partner = open.pop().expect("brackets are balanced");
                partners[k] = partner;
                partners[partner] = k;
            }
            depths[k] = open.len();
            if matches!(sign, "(" | "[" | "{") {
                open.push(k);
            }
        }
        Self {
            text,
            tokens,
            partners,
            depths,
        }
    }

    /// Text of a token; none before the first and after the last one.
    pub(super) fn at(&self, k: usize) -> &'a str {
        let token = self.tokens.get(k);
        token.map_or("", |token| &self.text[token.place.clone()])
    }

    /// Text of the token before.
    pub(super) fn before(&self, k: usize) -> &'a str {
        k.checked_sub(1).map_or("", |k| self.at(k))
    }

    pub(super) fn is(&self, k: usize, form: Form) -> bool {
        self.tokens.get(k).is_some_and(|token| token.form == form)
    }

    pub(super) fn partner(&self, k: usize) -> usize {
        self.partners[k]
    }

    /// The bracket around a token, if it stands in any.
    pub(super) fn around(&self, k: usize) -> Option<usize> {
        let depth = self.depths[k];
        (0..k)
            .rev()
            .find(|before| {
                matches!(self.at(*before), "(" | "[" | "{") && self.partners[*before] > k
            })
            .filter(|_| depth > 0)
    }

    /// Whether any bracket is open at a token.
    pub(super) fn is_inside(&self, k: usize) -> bool {
        self.depths[k] > 0
    }

    /// Place of the tokens from `first` to `last`.
    pub(super) fn place(&self, first: usize, last: usize) -> Range<usize> {
        self.tokens[first].place.start..self.tokens[last].place.end
    }

    /// Text of the tokens from `first` to `last`.
    pub(super) fn of(&self, first: usize, last: usize) -> &'a str {
        &self.text[self.place(first, last)]
    }

    /// First token of the operand that ends before token `k`.
    pub(super) fn operand_before(&self, k: usize) -> Option<usize> {
        let mut first = k.checked_sub(1)?;
        while matches!(self.at(first), "]") {
            first = self.partner(first).checked_sub(1)?;
        }
        match self.at(first) {
            ")" | "}" => Some(self.partner(first)),
            _ if self.is(first, Form::Sign) => None,
            _ => Some(first),
        }
    }

    /// Last token of the operand that begins after token `k`.
    pub(super) fn operand_after(&self, k: usize) -> Option<usize> {
        let mut last = match self.at(k + 1) {
            "(" | "{" => self.partner(k + 1),
            _ if self.is(k + 1, Form::Sign) => return None,
            _ => k + 1,
        };
        while self.at(last + 1) == "[" {
            last = self.partner(last + 1);
        }
        Some(last)
    }

    /// First token from `k` on, at the depth of `k`, that is one of `signs` or closes a bracket.
    pub(super) fn end_of(&self, k: usize, signs: &[&str]) -> usize {
        let mut end = k;
        while end < self.tokens.len() {
            match self.at(end) {
                sign if signs.contains(&sign) => return end,
                ")" | "]" | "}" => return end,
                "(" | "[" | "{" => end = self.partner(end) + 1,
                _ => end += 1,
            }
        }
        end
    }
}

/// Takes a text apart.
fn tokens(text: &str) -> Vec<Token> {
    let bytes = text.as_bytes();
    let is_word = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_' || byte == b'$';
    let find = |from: usize, what: &str| {
        let found = text[from..].find(what);
        found.map_or(text.len(), |at| from + at + what.len())
    };
    let mut tokens = Vec::new();
    let mut k = 0;
    while k < bytes.len() {
        let rest = &text[k..];
        let start = k;
        if bytes[k].is_ascii_whitespace() {
            k += 1;
        } else if rest.starts_with("//") {
            k = find(k, "\n");
        } else if rest.starts_with("/*") {
            k = find(k, "*/");
        } else if rest.starts_with("`if") {
            // Waveforms and names of states: what is not synthesised.
            k = find(k, "`endif");
        } else if bytes[k] == b'`' {
            k = find(k, "\n");
        } else if bytes[k] == b'"' {
            k = find(k + 1, "\"");
        } else if bytes[k].is_ascii_digit() {
            while k < bytes.len() && (is_word(bytes[k]) || bytes[k] == b'\'') {
                k += 1;
            }
            tokens.push(Token {
                form: Form::Number,
                place: start..k,
            });
        } else if is_word(bytes[k]) {
            while k < bytes.len() && is_word(bytes[k]) {
                k += 1;
            }
            tokens.push(Token {
                form: Form::Word,
                place: start..k,
            });
        } else {
            let long = LONG_SIGNS.iter().find(|sign| rest.starts_with(**sign));
            k += long.map_or(1, |sign| sign.len());
            tokens.push(Token {
                form: Form::Sign,
                place: start..k,
            });
        }
    }
    tokens
}

//! The program as a user meets it.

mod cli_budget;
mod cli_manual;
mod cli_words;
mod program;

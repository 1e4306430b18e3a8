//! Filters: textbook forms, those of the patent, words and programs from outside.

mod comparison_filters;
mod patent_filter;
mod process;
mod replay;
mod textbook;

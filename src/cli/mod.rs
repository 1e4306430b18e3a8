//! The command line: one file per command, exit codes, and the only code that prints.

//! Arguments to the command line, and its exit code to the shell.

fn main() {}

//! The `bricard` command.

fn main() {}

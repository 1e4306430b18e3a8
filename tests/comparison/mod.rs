//! Results beside others: tables over scenarios, baselines, build servers.

mod build_servers;
mod compare;
mod comparison_change;
mod false_alarms;
mod tables;

//! The program as its users run it: command lines, exit codes, messages, files.

mod accuracy;
mod bad_outputs;
mod bad_points;
mod bad_recordings;
mod bad_scenarios;
mod chain;
mod command_line;
mod compare;
mod determinism;
mod evolution;
mod foreign;
mod growth;
mod harness;
mod interruption;
mod judgements;
mod known_points;
mod oscillator;
mod pseudo_excitation;
mod random;
mod study;

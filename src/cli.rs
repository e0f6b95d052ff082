//! The command line.

use clap::{Args, Parser, Subcommand, ValueEnum};
use std::ops::Range;
use std::path::PathBuf;

/// Probability densities of bridge and vehicle responses by the direct probability integral method.
///
/// Stages are separate commands linked by files:
/// scenario.toml -> excite -> simulate -> density, reliability -> plot.
#[derive(Debug, Parser)]
#[command(name = "dpim", version, propagate_version = true)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
    #[command(flatten)]
    pub general: General,
}

/// What every command takes.
#[derive(Debug, Clone, Args)]
pub struct General {
    /// Threads to use [default: all cores]; results do not depend on it
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// No progress bar and no notes
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Say what is done and how
    #[arg(short, long, global = true)]
    pub verbose: bool,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Choose representative points and write their irregularities (points.parquet)
    Excite(Excite),
    /// Run one deterministic simulation a point (responses.mcap)
    Simulate(Simulate),
    /// Smooth the weighted responses into densities (density.parquet)
    Density(Density),
    /// First-passage reliability of every limit of the scenario (reliability.parquet)
    Reliability(Reliability),
    /// Distances between two tables of densities, or between one and an exact one
    Compare(Compare),
    /// Write the exact density of a system that has one (density.parquet)
    Exact(Exact),
    /// How the error falls with the number of points, for rules of points and of smoothing (study.parquet)
    Study(Study),
    /// Draw a figure from any of the files (SVG or PNG)
    Plot(Plot),
    /// Frequencies, largest stable step, cost and sizes of a scenario, before the work
    Check(Check),
    /// What a file is: kind, version, provenance, quantities, units, ranges
    Inspect(Inspect),
    /// Print the contract of the scenario or of a kind of file
    Schema(Schema),
    /// Print the completions of a shell
    Completions(Completions),
}

/// The scenario of a stage that needs one.
#[derive(Debug, Clone, Args)]
pub struct ScenarioArgs {
    /// The scenario
    #[arg(short, long, value_name = "SCENARIO.toml")]
    pub scenario: PathBuf,
    /// Override a key of the scenario, or without a value remove it; repeatable
    #[arg(long = "set", value_name = "KEY.PATH=[VALUE]")]
    pub sets: Vec<String>,
}

/// The scenario of a stage that has one in its input.
#[derive(Debug, Clone, Args)]
pub struct OptionalScenarioArgs {
    /// The scenario [default: the one in the recording]
    #[arg(short, long, value_name = "SCENARIO.toml")]
    pub scenario: Option<PathBuf>,
    /// Override a key of the scenario, or without a value remove it; repeatable
    #[arg(long = "set", value_name = "KEY.PATH=[VALUE]")]
    pub sets: Vec<String>,
}

/// Where a result goes.
#[derive(Debug, Clone, Args)]
pub struct OutputArgs {
    /// The output; an existing one is replaced when the new one is whole
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Refuse to replace an existing output
    #[arg(long)]
    pub no_clobber: bool,
}

#[derive(Debug, Args)]
pub struct Excite {
    #[command(flatten)]
    pub scenario: ScenarioArgs,
    #[command(flatten)]
    pub output: OutputArgs,
    /// Write the deterministic irregularity and the harmonics of the random one instead of representative points:
    /// `density` then gives the exact normal densities of a linear system. The table [points] is not used
    #[arg(long, conflicts_with_all = ["seed", "count"])]
    pub pseudo_excitation: bool,
    /// Override points.seed
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Override points.count
    #[arg(long, value_name = "N")]
    pub count: Option<u32>,
}

#[derive(Debug, Args)]
pub struct Simulate {
    #[command(flatten)]
    pub scenario: ScenarioArgs,
    /// The points file
    #[arg(value_name = "POINTS.parquet")]
    pub points: PathBuf,
    #[command(flatten)]
    pub output: OutputArgs,
    /// Only the points A, A+1, ... B-1
    #[arg(long = "points", value_name = "A..B", value_parser = parse_range)]
    pub range: Option<Range<u32>>,
}

#[derive(Debug, Args)]
pub struct Density {
    #[command(flatten)]
    pub scenario: OptionalScenarioArgs,
    /// Recordings of disjoint points: one ensemble
    #[arg(value_name = "RECORDING.mcap", required = true)]
    pub recordings: Vec<PathBuf>,
    #[command(flatten)]
    pub output: OutputArgs,
    /// The points file that was simulated, for rules of smoothing that know the points' variables
    #[arg(long, value_name = "POINTS.parquet")]
    pub points: Option<PathBuf>,
    /// Also write moments and quantiles of every quantity and time
    #[arg(long, value_name = "FILE")]
    pub moments: Option<PathBuf>,
    /// How densities are made of the responses, in place of the scenario's method
    #[arg(long, value_enum)]
    pub method: Option<DensityMethod>,
}

#[derive(Debug, Args)]
pub struct Reliability {
    #[command(flatten)]
    pub scenario: OptionalScenarioArgs,
    /// Recordings of disjoint points: one ensemble
    #[arg(value_name = "RECORDING.mcap", required = true)]
    pub recordings: Vec<PathBuf>,
    #[command(flatten)]
    pub output: OutputArgs,
    /// Also write the density of every limit's extreme value
    #[arg(long, value_name = "FILE")]
    pub extremes: Option<PathBuf>,
}

/// How densities are made of the responses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DensityMethod {
    /// A smoothed sum over the points, each time by itself
    DirectIntegral,
    /// Each point's probability is moved by its velocity
    DensityEvolution,
}

#[derive(Debug, Args)]
pub struct Compare {
    /// A table of densities
    #[arg(value_name = "FIRST.parquet")]
    pub first: PathBuf,
    /// The table that it is compared with; errors are the first less this one
    #[arg(value_name = "SECOND.parquet")]
    pub second: PathBuf,
    /// Also write all distances as a table; an existing one is replaced when the new one is whole
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Refuse to replace an existing output
    #[arg(long, requires = "output")]
    pub no_clobber: bool,
    /// Quantiles whose errors are wanted, separated by commas
    #[arg(
        long = "quantile",
        value_name = "P1,P2,...",
        value_delimiter = ',',
        default_value = "0.01,0.5,0.99"
    )]
    pub quantiles: Vec<f64>,
    /// Only these times (s), separated by commas [default: all that both tables have]
    #[arg(long, value_name = "T1,T2,...", value_delimiter = ',')]
    pub times: Vec<f64>,
    /// Print a line for each time instead of a summary
    #[arg(long)]
    pub all: bool,
}

#[derive(Debug, Args)]
pub struct Exact {
    #[command(flatten)]
    pub scenario: ScenarioArgs,
    #[command(flatten)]
    pub output: OutputArgs,
}

#[derive(Debug, Args)]
pub struct Study {
    #[command(flatten)]
    pub scenario: ScenarioArgs,
    #[command(flatten)]
    pub output: OutputArgs,
}

/// The figures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Figure {
    /// A few irregularities (points)
    Samples,
    /// Averaged periodogram on the target spectrum (points)
    Periodogram,
    /// All responses with mean and quantiles (recording)
    Fan,
    /// The density over time and value, in colours (density)
    HeatMap,
    /// The density over time and value, in space (density)
    Surface,
    /// The density at given times (density)
    Slices,
    /// The probability of failure over time (reliability)
    FailureProbability,
    /// The distances between two densities over time (comparison)
    Distances,
    /// The error over the number of points (study)
    Convergence,
    /// The error over the processor time (study)
    Work,
}

/// What a density's value axis shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ValueAxis {
    /// The deviation from the mean where the spread is small beside the travel
    Auto,
    /// The value itself
    Value,
    /// The deviation from the mean
    Deviation,
}

#[derive(Debug, Args)]
pub struct Plot {
    /// A points file, a recording, or a result table
    #[arg(value_name = "FILE")]
    pub input: PathBuf,
    #[command(flatten)]
    pub output: OutputArgs,
    /// Which figure [default: the first one that the file's kind has]
    #[arg(long, value_enum)]
    pub figure: Option<Figure>,
    /// Which quantity or limit [default: the first; for failure-probability: all limits]
    #[arg(long, value_name = "NAME")]
    pub quantity: Option<String>,
    /// Times of slices (s), separated by commas
    #[arg(long, value_name = "T1,T2,...", value_delimiter = ',')]
    pub at: Vec<f64>,
    /// What the value axis of a density shows
    #[arg(long, value_enum, default_value = "auto")]
    pub axis: ValueAxis,
}

#[derive(Debug, Args)]
pub struct Check {
    #[command(flatten)]
    pub scenario: ScenarioArgs,
}

#[derive(Debug, Args)]
pub struct Inspect {
    /// A file of any kind
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
}

/// What has a schema.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SchemaOf {
    Scenario,
    Points,
    Recording,
    Density,
    Moments,
    Reliability,
    Comparison,
    Study,
}

#[derive(Debug, Args)]
pub struct Schema {
    /// Of what
    #[arg(value_enum, default_value = "scenario")]
    pub of: SchemaOf,
}

#[derive(Debug, Args)]
pub struct Completions {
    /// The shell
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}

/// `A..B` with A < B.
fn parse_range(text: &str) -> Result<Range<u32>, String> {
    let expected = "expected a range of points A..B with A < B, counted from 0";
    let (first, end) = text.split_once("..").ok_or_else(|| expected.to_owned())?;
    let number = |text: &str| text.trim().parse::<u32>().map_err(|_| expected.to_owned());
    let range = number(first)?..number(end)?;
    if range.is_empty() {
        return Err(expected.to_owned());
    }
    Ok(range)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn ranges() {
        assert_eq!(parse_range("5..30"), Ok(5..30));
        for bad in ["5..3", "5..5", "5", "a..b", "-1..3", "..4"] {
            assert!(
                parse_range(bad)
                    .unwrap_err()
                    .starts_with("expected a range"),
                "{bad}"
            );
        }
    }
}

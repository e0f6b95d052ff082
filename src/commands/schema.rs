//! `dpim schema`: the contracts, as they lie in `schemas/`.

use crate::Result;
use crate::cli::{self, SchemaOf};
use crate::files::{Kind, schemas};
use crate::scenario;

pub(super) fn run(args: &cli::Schema) -> Result<()> {
    let text = match args.of {
        SchemaOf::Scenario => format!("{:#}\n", scenario::json_schema()),
        SchemaOf::Points => schemas::document(Kind::Points).to_owned(),
        SchemaOf::Recording => schemas::document(Kind::Recording).to_owned(),
        SchemaOf::Density => schemas::document(Kind::Density).to_owned(),
        SchemaOf::Moments => schemas::document(Kind::Moments).to_owned(),
        SchemaOf::Comparison => schemas::document(Kind::Comparison).to_owned(),
        SchemaOf::Study => schemas::document(Kind::Study).to_owned(),
        SchemaOf::Reliability => schemas::document(Kind::Reliability).to_owned(),
    };
    super::print(&text)
}

//! Writes include/carom.h from what C may call; its test says whether it is up to date.

use std::fs;
use std::path::Path;
use std::process::ExitCode;

use cbindgen::{Builder, Config};

/// In the order of the header.
const SOURCES: [&str; 8] = [
    "status.rs",
    "compliance.rs",
    "door/messages.rs",
    "door/setup.rs",
    "door/books.rs",
    "door/contact.rs",
    "door/results.rs",
    "door/friction.rs",
];

const TOP: &str = "/* carom: exact frictional contact in time loops of your own.
 *
 * Written by `cargo run --release -p carom-c --example header`; do not edit.
 *
 * A step of your loop is carom_contact_search, then until your iterations have converged carom_contact_evaluate and carom_contact_solve, then
 * carom_contact_missed and carom_contact_accept. What there is and what may touch what is described before by carom_setup_...
 *
 * Every function but those that free returns a carom_status; carom_last_error() says what is wrong. Units are SI. Numbers of nodes, unknowns and contacts are from 0. Arrays of
 * shape [a][b] have the b numbers of the first row first.
 *
 * What has to hold of pointers: a handle is one that carom wrote and that was not freed; arrays have the sizes that are said, and nobody changes them during the call; texts end with a
 * zero; where something is written there is room for it, and nothing of the input lies there unless it says so. Null and sizes that do not fit
 * are refused. A handle serves one call at a time, and may go from one thread to another. Nothing is kept of what you give but copies.
 */";

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let header = root.join("include/carom.h");
    let written = match written(root) {
        Ok(text) => text,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    };
    match fs::write(&header, written) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error}", header.display());
            ExitCode::FAILURE
        }
    }
}

/// The header as it has to be.
fn written(root: &Path) -> Result<Vec<u8>, String> {
    let config = Config::from_file(root.join("cbindgen.toml"))?;
    let start = Builder::new().with_config(config).with_header(TOP);
    let builder = SOURCES.iter().fold(start, |builder, file| builder.with_src(root.join("src").join(file)));
    let mut text = Vec::new();
    builder.generate().map_err(|e| e.to_string())?.write(&mut text);
    Ok(text)
}

#[test]
fn the_header_is_up_to_date() -> Result<(), String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let there = fs::read(root.join("include/carom.h")).map_err(|e| e.to_string())?;
    assert!(there == written(root)?, "run cargo run --release -p carom-c --example header");
    Ok(())
}

//! Every drawing without errors becomes a sheet of paper pieces, or it is said why not; the sheet is a drawing that okoshi reads.

use glam::DVec2;
use okoshi::compile::{Options, compile};
use okoshi::internals::disk::decode;
use okoshi::internals::puppet::{self, PuppetError, sheet};

use super::{drawing, files};

/// Millimetres.
const A4: DVec2 = DVec2::new(210.0, 297.0);

pub(super) fn check(bytes: &[u8]) -> bool {
    let Ok(text) = decode(bytes.to_vec()) else {
        return false;
    };
    let resolver = drawing::linked();
    let compiled = compile(&text, &Options::default(), &resolver);
    if compiled.has_errors() {
        return false;
    }
    // As large as fits, and at a scale that may be too large or too small.
    let scales = [None, Some(f64::from(bytes.len() as u8) / 16.0 + 0.01)];
    let mut is_made = false;
    for scale in scales {
        let options = puppet::Options { page: A4, scale };
        match sheet(&compiled, &text, "drawing", &resolver, &options) {
            Ok(sheet) => {
                assert!(sheet.pieces > 0 && sheet.pages > 0);
                assert!(sheet.scale > 0.0 && sheet.scale.is_finite() && sheet.size.is_finite());
                let read = compile(&sheet.svg, &Options::default(), &resolver);
                assert!(!read.has_crashed() && !read.drawing.groups.is_empty());
                is_made = true;
            }
            Err(PuppetError::Crash(crash)) => panic!("{crash}"),
            Err(_) => {}
        }
    }
    is_made
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    files::cases().into_iter().map(String::into_bytes).collect()
}

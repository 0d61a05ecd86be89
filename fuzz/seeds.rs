//! The inputs that the search begins with, as files: fuzz/run.sh asks for them.

use std::path::PathBuf;

use crate::fuzzing::Target;

/// If `OKOSHI_FUZZ_SEEDS` names a folder, writes the seeds of the target into it and ends the process.
pub(crate) fn write_if_asked(target: &Target) {
    let Some(folder) = std::env::var_os("OKOSHI_FUZZ_SEEDS") else {
        return;
    };
    for (index, seed) in (target.seeds)().iter().enumerate() {
        let path = PathBuf::from(&folder).join(format!("seed-{index}"));
        std::fs::write(&path, seed).expect("the folder is writable");
    }
    std::process::exit(0);
}

//! See tests/fuzzing/changes.rs.
#![no_main]

#[path = "../../tests/fuzzing/mod.rs"]
mod fuzzing;
#[path = "../seeds.rs"]
mod seeds;

libfuzzer_sys::fuzz_target!(init: seeds::write_if_asked(fuzzing::target("changes")), |bytes: &[u8]| {
    (fuzzing::target("changes").check)(bytes);
});

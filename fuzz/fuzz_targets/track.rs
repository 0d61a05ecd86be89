//! See tests/fuzzing/track.rs.
#![no_main]

#[path = "../../tests/fuzzing/mod.rs"]
mod fuzzing;
#[path = "../seeds.rs"]
mod seeds;

libfuzzer_sys::fuzz_target!(init: seeds::write_if_asked(fuzzing::target("track")), |bytes: &[u8]| {
    (fuzzing::target("track").check)(bytes);
});

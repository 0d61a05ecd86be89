//! See tests/fuzzing/tiled.rs.
#![no_main]

#[path = "../../tests/fuzzing/mod.rs"]
mod fuzzing;
#[path = "../seeds.rs"]
mod seeds;

libfuzzer_sys::fuzz_target!(init: seeds::write_if_asked(fuzzing::target("tiled")), |bytes: &[u8]| {
    (fuzzing::target("tiled").check)(bytes);
});

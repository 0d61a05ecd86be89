//! See tests/fuzzing/character.rs.
#![no_main]

#[path = "../../tests/fuzzing/mod.rs"]
mod fuzzing;
#[path = "../seeds.rs"]
mod seeds;

libfuzzer_sys::fuzz_target!(init: seeds::write_if_asked(fuzzing::target("character")), |bytes: &[u8]| {
    (fuzzing::target("character").check)(bytes);
});

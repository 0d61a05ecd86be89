//! See tests/fuzzing/drawing.rs.
#![no_main]

#[path = "../../tests/fuzzing/mod.rs"]
mod fuzzing;
#[path = "../seeds.rs"]
mod seeds;

libfuzzer_sys::fuzz_target!(init: seeds::write_if_asked(fuzzing::target("drawing")), |bytes: &[u8]| {
    (fuzzing::target("drawing").check)(bytes);
});

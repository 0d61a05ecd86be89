//! See tests/fuzzing/model.rs.
#![no_main]

#[path = "../../tests/fuzzing/mod.rs"]
mod fuzzing;
#[path = "../seeds.rs"]
mod seeds;

libfuzzer_sys::fuzz_target!(init: seeds::write_if_asked(fuzzing::target("model")), |bytes: &[u8]| {
    (fuzzing::target("model").check)(bytes);
});

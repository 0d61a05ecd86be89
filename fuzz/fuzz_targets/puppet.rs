//! See tests/fuzzing/puppet.rs.
#![no_main]

#[path = "../../tests/fuzzing/mod.rs"]
mod fuzzing;
#[path = "../seeds.rs"]
mod seeds;

libfuzzer_sys::fuzz_target!(init: seeds::write_if_asked(fuzzing::target("puppet")), |bytes: &[u8]| {
    (fuzzing::target("puppet").check)(bytes);
});

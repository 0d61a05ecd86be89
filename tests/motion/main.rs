//! Motion capture from file to figure.

mod carry;
mod limited;

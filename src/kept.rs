//! What a step gave the last time, kept with what it was made from.

use std::sync::Arc;

/// The last result of a pure function and what it was made from.
#[derive(Debug)]
pub(crate) struct Kept<Input, Output>(Option<(Input, Output)>);

impl<Input, Output> Default for Kept<Input, Output> {
    fn default() -> Self {
        Self(None)
    }
}

impl<Input: PartialEq, Output: Clone> Kept<Input, Output> {
    /// What `make` gives, or gave where the input is what it was the last time.
    pub(crate) fn get(&mut self, input: Input, make: impl FnOnce(&Input) -> Output) -> Output {
        if let Some((known, output)) = &self.0
            && *known == input
        {
            return output.clone();
        }
        let output = make(&input);
        self.0 = Some((input, output.clone()));
        output
    }
}

/// Something shared, which equals what lies at the same place: comparing takes no time.
#[derive(Debug)]
pub(crate) struct Same<T>(pub(crate) Arc<T>);

impl<T> Clone for Same<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> PartialEq for Same<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

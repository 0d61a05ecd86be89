//! Which joint drives which part, and why.

use typed_index_collections::{TiVec, ti_vec};

use crate::compile::Compiled;
use crate::ide::PartId;

/// The joint that drives a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Driver<'a> {
    /// Its name; `None` for a part that follows its parent.
    pub joint: Option<&'a str>,
    /// The reason.
    pub why: &'a str,
}

/// Per part the joint that drives it, from the first clip of its figure in which one does, else the first clip's reason why none does.
/// `None` for parts of figures that do not move.
pub(crate) fn drivers(compiled: &Compiled) -> TiVec<PartId, Option<Driver<'_>>> {
    let mut drivers: TiVec<PartId, Option<Driver>> = ti_vec![None; compiled.bindings.parts.len()];
    for clip in &compiled.clips {
        for drive in &clip.parts {
            let driver = &mut drivers[drive.part];
            let is_better =
                driver.is_none_or(|driver| driver.joint.is_none() && drive.joint.is_some());
            if is_better {
                *driver = Some(Driver {
                    joint: drive.joint.map(|joint| clip.joint_name(joint)),
                    why: &drive.why,
                });
            }
        }
    }
    drivers
}

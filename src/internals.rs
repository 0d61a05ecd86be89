//! What the program's binary, tests, benchmarks and fuzzing targets use beside the documented API. It is not for others: it changes
//! without notice. Whatever is neither documented nor named here is private to the crate.

pub mod assemble {
    pub use crate::assemble::world_transform;
}
pub mod billboard {
    pub use crate::billboard::{Character, RegionId, ViewId, stages};
}
pub mod bind {
    pub use crate::bind::{PartId, PartKind, bind, in_layers_of_pixels, makes_pose_layer};
}
pub mod budget {
    pub use crate::budget::{STEPS, counted};
}
#[cfg(feature = "cli")]
pub mod cli {
    pub use crate::cli::run;

    pub mod report {
        pub use crate::cli::report::{Style, human};
    }
}
pub mod clips {
    pub use crate::clips::{BuiltIn, Legs};
}
pub mod crash {
    pub use crate::crash::*;
}
#[cfg(feature = "disk")]
pub mod disk {
    pub use crate::disk::decode;
}
pub mod geometry {
    pub use crate::geometry::{
        FillRule, Outline, area, border_distance_squared, bounds, contains, intersect,
        resolve_overlaps,
    };
}
pub mod ide {
    pub use crate::ide::Analysis;

    pub mod changes {
        pub use crate::ide::changes::{
            Change, History, Moment, NewShape, PartTurn, Place, Refusal, Stacking, Step, can_set,
            check, edits, part_after, rebased,
        };
    }
}
pub mod import {
    pub use crate::import::{ImportError, read_static_model};
}
pub mod labels {
    pub use crate::labels::{
        Anatomy, Class, Facing, FigurePartId, Limb, LimbSegment, Side, Tip, label_clip,
    };
}
pub mod lang {
    pub use crate::lang::{Container, parse, reference, settings};

    pub mod keyword {
        pub use crate::lang::keyword::Keyword;

        pub mod kinds {
            pub use crate::lang::keyword::kinds::KINDS;
        }
    }
    pub mod value {
        pub use crate::lang::value::Setting;
    }
    pub mod variables {
        pub use crate::lang::variables::Variables;
    }
}
pub mod limited {
    pub use crate::limited::{
        Camera, Cut, Drawing, Exposure, Length, MAX_OMITTED_RUN, Measured, Method, Options, Poses,
        compare, drawings, error, every, limit, ssd,
    };
}
#[cfg(feature = "render")]
pub mod look {
    pub use crate::look::{DrawnView, Instead, Look, compare, hints};
}
#[cfg(feature = "lsp")]
pub mod lsp {
    pub use crate::lsp::{pass_on, serve_client};
}
pub mod mark_tracks {
    pub use crate::mark_tracks::{ErrorLocation, MarkTracks};
}
pub mod mocap {
    pub use crate::mocap::{Axis, Channel, Clip, Joint, JointId, Pose, Skeleton, Transform};

    pub mod bvh {
        pub use crate::mocap::bvh::{Decimals, MAX_MAGNITUDE, Reading, read, read_bytes, write};
    }
    pub mod resample {
        pub use crate::mocap::resample::{TimeMap, resample};
    }
}
pub mod motion {
    pub use crate::motion::PointChoice;

    pub mod edit {
        pub use crate::motion::edit::{ExposureMethod, Options, edit};
    }
}
pub mod performance {
    pub use crate::performance::Filming;
}
pub mod prepare {
    pub use crate::prepare::{Options, PreparedClip, built_in, find_lead_in, prepare};
}
#[cfg(feature = "page")]
pub mod page {
    pub use crate::page::{Studio, Tried, film, trace};
}
#[cfg(feature = "protocol")]
pub mod protocol {
    pub use crate::protocol::Server;
}
pub mod puppet {
    pub use crate::puppet::{MarkOrigin, Options, PaperPiece, PuppetError, Sheet, pieces, sheet};
}
pub mod report {
    pub use crate::report::{Findings, picture_of_matches};
}
pub mod retarget {
    pub use crate::retarget::{
        Drive, Follow, Landmarks, RestSource, RetargetedClip, Rig, RigPart, Turns, retarget,
    };
}
pub mod rig {
    pub use crate::rig::FigureClip;
}
pub mod solid {
    pub use crate::solid::{Sides, Solid};
}
pub mod source {
    pub use crate::source::{Text, escape_xml};
}
pub mod svg {
    pub use crate::svg::{GroupId, LeftOut, ShapeId, raster, read};
}
pub mod terrain {
    pub use crate::terrain::{
        AmbiguityKind, DEFAULT_ROOF, EDGE_BELOW, EDGE_RIGHT, HouseInfo, Landscape, Map, Tile, UNSET,
    };
}
#[cfg(feature = "tracking")]
pub mod tracking {
    pub use crate::tracking::{Follower, Frame, Learner, Mark, Tracker};
}

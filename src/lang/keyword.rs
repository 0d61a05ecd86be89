//! The language as one table.

macro_rules! keywords {
    ($($(#[doc = $doc:literal])+ $name:ident;)+) => {
        /// A keyword of the language.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Keyword { $($(#[doc = $doc])+ $name,)+ }
    };
}

keywords! {
    /// `Color`
    Color;
    /// `Shape`
    Shape;
    /// `Offset`
    Offset;
    /// `Origin`
    Origin;
    /// `Axis`
    Axis;
    /// `Segments`
    Segments;
    /// `Smooth`
    Smooth;
    /// `Metallic`
    Metallic;
    /// `Roughness`
    Roughness;
    /// `Emissive`
    Emissive;
    /// `Alpha`
    Alpha;
    /// `Texture`
    Texture;
    /// `Depth`
    Depth;
    /// `Bone`
    Bone;
    /// `Mark`
    Mark;
    /// `Follow`
    Follow;
    /// `Tiles`
    Tiles;
    /// `Tile`
    Tile;
    /// `Bevel`
    Bevel;
    /// `Roof`
    Roof;
    /// `View`
    View;
    /// `Backing`
    Backing;
    /// `Hidden`
    Hidden;
    /// `Scale`
    Scale;
    /// `Axes`
    Axes;
    /// `Ground`
    Ground;
    /// `Let`
    Let;
    /// `Bind`
    Bind;
    /// `Strokes`
    Strokes;
    /// `Motion`
    Motion;
    /// `Limited`
    Limited;
    /// `Stand`
    Stand;
    /// `Size`
    Size;
    /// `Walk`
    Walk;
    /// `Pose`
    Pose;
    /// `Perform`
    Perform;
}

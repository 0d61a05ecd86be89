//! Drawings to start from: for `okoshi new`, and for pages that have no drawing yet.

/// A drawing to start from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Template {
    Girl,
    Boy,
    Dog,
    Dragon,
    Robot,
    RacingCar,
    Island,
    Turning,
    Empty,
}

impl Template {
    /// All of them, in the order of lists.
    pub(crate) const ALL: [Self; 9] = [
        Self::Girl,
        Self::Boy,
        Self::Dog,
        Self::Dragon,
        Self::Robot,
        Self::RacingCar,
        Self::Island,
        Self::Turning,
        Self::Empty,
    ];

    /// What it is called.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Girl => "girl",
            Self::Boy => "boy",
            Self::Dog => "dog",
            Self::Dragon => "dragon",
            Self::Robot => "robot",
            Self::RacingCar => "racing-car",
            Self::Island => "island",
            Self::Turning => "turning",
            Self::Empty => "empty",
        }
    }

    /// What it may be called as well.
    pub(crate) fn alias(self) -> Option<&'static str> {
        match self {
            Self::Girl => Some("human"),
            Self::RacingCar => Some("car"),
            _ => None,
        }
    }

    /// What it shows.
    pub(crate) fn about(self) -> &'static str {
        match self {
            Self::Girl => "A girl who walks",
            Self::Boy => "A boy who walks and waves",
            Self::Dog => "A dog who walks, drawn from the side",
            Self::Dragon => "A dragon who flies, drawn from the side",
            Self::Robot => "A robot who walks and dances",
            Self::RacingCar => "A racing car whose wheels turn, drawn from the side",
            Self::Island => {
                "A landscape, drawn as a map of tiles: hills, houses and trees in the sea"
            }
            Self::Turning => "A fox that turns, drawn from two sides",
            Self::Empty => "A page with guides, and strings to copy",
        }
    }

    /// The drawing, as Inkscape saves it. It links to nothing.
    pub(crate) fn drawing(self) -> &'static str {
        match self {
            Self::Girl => include_str!("../../examples/girl.svg"),
            Self::Boy => include_str!("boy.svg"),
            Self::Dog => include_str!("dog.svg"),
            Self::Dragon => include_str!("dragon.svg"),
            Self::Robot => include_str!("robot.svg"),
            Self::RacingCar => include_str!("racing-car.svg"),
            Self::Island => include_str!("island.svg"),
            Self::Turning => include_str!("turning.svg"),
            Self::Empty => include_str!("empty.svg"),
        }
    }

    /// Whether it has shapes of which there is a model.
    pub(crate) fn has_model(self) -> bool {
        self != Self::Empty
    }
}

//! What the parts of a figure are to a clip that moves them.

use glam::{DVec2, DVec3};
use typed_index_collections::{TiVec, ti_vec};

use crate::anatomy::{self, Term};
use crate::clips::BuiltIn;
use crate::diagnostic::listed;
use crate::labels::{
    Class, Facing, Figure, FigurePart, FigurePartId, FoundFacing, Label, Side, label_drawn,
};

/// A wheel that rolls stands at most this share of the figure's height above its ground.
const LOW: f64 = 0.2;
/// A wheel that is seen from its side is at most this much longer than wide.
const ROUND: f64 = 1.4;
/// The middles of a wheel and its rim are at most this share of the wheel's radius apart.
const CONCENTRIC: f64 = 0.3;
/// So many legs under a head are tentacles: those of an octopus.
const MANY_LEGS: usize = 7;
/// Without a name of a tail, a fin is one if it begins in this share of the figure's length behind its front.
const REAR: f64 = 0.6;
/// What sticks out of its parent by more than this share of its own size sways by itself; what does not is a pattern on it.
const STICKS_OUT: f64 = 0.3;

/// What a part moves as. The numbers are those of [`Role::NAMES`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::rig) enum Role {
    /// The root, which carries all others.
    Body,
    /// A wheel that rolls.
    Wheel,
    Wing,
    Fin,
    Tail,
    Tentacle,
    Leg,
    /// Anything else that sticks out of what it hangs on.
    Twig,
}

impl Role {
    /// The names, as if they were joints.
    pub(in crate::rig) const NAMES: [&'static str; 8] = [
        "body", "wheel", "wing", "fin", "tail", "tentacle", "leg", "twig",
    ];

    /// What it does, for people to read.
    pub(super) fn does(self) -> &'static str {
        match self {
            Self::Body => "it carries the others",
            Self::Wheel => "it rolls",
            Self::Wing => "it beats",
            Self::Fin => "it paddles",
            Self::Tail => "it strikes to both sides",
            Self::Tentacle => "it waves",
            Self::Leg => "it trails behind",
            Self::Twig => "it sways",
        }
    }
}

/// A part of the figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Actor {
    /// What it moves as.
    pub(super) role: Option<Role>,
    /// How many parts of its role carry it.
    pub(super) depth: usize,
    /// From its joint to its tip, drawing units, y up.
    pub(super) span: DVec2,
    /// The middle of its bounds.
    pub(super) center: DVec2,
    /// Of a wheel half its height.
    pub(super) radius: f64,
    /// 1 on the figure's left, −1 on its right.
    pub(super) side: f64,
    /// A share of a cycle by which it is late, so that neighbours do not move as one.
    pub(super) lag: f64,
}

/// The parts of a figure and their roles.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::rig) struct Roles {
    pub(super) parts: TiVec<FigurePartId, Actor>,
    pub(super) labels: TiVec<FigurePartId, Option<Label>>,
    pub(super) facing: FoundFacing,
    pub(super) root: FigurePartId,
    /// Where it goes, a unit vector in the drawing's axes.
    pub(super) forward: DVec3,
    /// Its bounds.
    pub(super) low: DVec2,
    pub(super) high: DVec2,
    /// Whether its root stands still while the others sway: a pot.
    pub(super) is_potted: bool,
    /// Whether names or a face show that it lives.
    is_alive: bool,
    /// Whether a name says that it is a plant, or a flag.
    is_plant: bool,
}

impl Roles {
    /// What a part is.
    pub(in crate::rig) fn label(&self, part: FigurePartId) -> Option<Label> {
        self.labels.get(part)?.clone()
    }

    /// Where the figure looks.
    pub(in crate::rig) fn facing(&self) -> FoundFacing {
        self.facing.clone()
    }

    /// The roles of a figure's parts.
    pub(in crate::rig) fn find(figure: &Figure, root: FigurePartId) -> Self {
        let labeled = label_drawn(figure);
        let none = [DVec2::INFINITY, DVec2::NEG_INFINITY];
        let bounds = figure.parts.iter().map(|part| part.bounds);
        let [low, high] = bounds.fold(none, |[low, high], [from, to]| {
            [low.min(from), high.max(to)]
        });
        let facing = labeled.facing.facing;
        let names = || figure.parts.iter().map(|part| part.name.as_str());
        let mut roles = Self {
            parts: ti_vec![Actor::default(); figure.parts.len()],
            forward: facing.turn() * DVec3::Z,
            is_alive: labeled.has_names || labeled.facing.has_face,
            is_plant: names().any(anatomy::is_plant),
            labels: labeled.labels,
            facing: labeled.facing,
            root,
            low,
            high,
            is_potted: false,
        };
        let has_body = roles.has_class(Class::Body);
        let legs = roles.labels.iter().flatten();
        let legs = legs.filter(|label| label.class == Class::Leg).count();
        let legs_are_tentacles = legs >= MANY_LEGS && !has_body && roles.has_class(Class::Head);
        for (index, part) in figure.parts.iter_enumerated() {
            let role = roles.role(part, index, figure, legs_are_tentacles);
            roles.parts[index] = roles.actor(part, index, role, facing);
        }
        roles.inner_discs();
        roles.fins_as_tails();
        roles.depths(figure);
        roles.is_potted = roles.stands_in_pot(figure);
        roles
    }

    fn role(
        &self,
        part: &FigurePart,
        index: FigurePartId,
        figure: &Figure,
        legs_are_tentacles: bool,
    ) -> Option<Role> {
        let terms = anatomy::terms(&part.name);
        let class = self.labels[index].as_ref().map(|label| label.class);
        let [low, high] = part.bounds;
        let size = high - low;
        let is_round = size.max_element() <= ROUND * size.min_element();
        let is_low = low.y <= self.low.y + LOW * self.height();
        if anatomy::is_rolling(&part.name) {
            let is_inner = part
                .parent
                .is_some_and(|above| anatomy::is_rolling(&figure.parts[above].name));
            let rolls = is_low && !is_inner && (is_round || !self.facing.facing.is_profile());
            return rolls.then_some(Role::Wheel);
        }
        if index == self.root {
            return None;
        }
        if terms.contains(&Term::Tail) || class == Some(Class::Tail) {
            return Some(Role::Tail);
        }
        if anatomy::is_tentacle(&part.name) {
            return Some(Role::Tentacle);
        }
        if anatomy::is_fin(&part.name) {
            return Some(Role::Fin);
        }
        if terms.contains(&Term::Wing) {
            return Some(Role::Wing);
        }
        match class {
            Some(Class::Leg) if legs_are_tentacles => Some(Role::Tentacle),
            Some(Class::Leg) => Some(Role::Leg),
            _ => self.sticks_out(part, figure).then_some(Role::Twig),
        }
    }

    fn sticks_out(&self, part: &FigurePart, figure: &Figure) -> bool {
        let Some(parent) = part.parent.map(|parent| figure.parts[parent].bounds) else {
            return false;
        };
        let [low, high] = part.bounds;
        let size = (high - low).max_element();
        let out = (parent[0] - low).max(high - parent[1]).max_element();
        out > STICKS_OUT * size
    }

    fn actor(
        &self,
        part: &FigurePart,
        index: FigurePartId,
        role: Option<Role>,
        facing: Facing,
    ) -> Actor {
        let [low, high] = part.bounds;
        let center = (low + high) / 2.0;
        let side = self.labels[index].as_ref().and_then(|label| label.side);
        let by_place = match facing {
            Facing::Viewer | Facing::UpHeadDown => center.x - self.middle().x,
            Facing::Away | Facing::Up => self.middle().x - center.x,
            // The near side is the left one of whoever faces left.
            Facing::Left => 1.0,
            Facing::Right => -1.0,
        };
        let length = (self.high.x - self.low.x).max(f64::MIN_POSITIVE);
        Actor {
            role,
            depth: 0,
            span: part.tip - part.joint,
            center,
            radius: (high.y - low.y) / 2.0,
            side: match side {
                Some(Side::Left) => 1.0,
                Some(Side::Right) => -1.0,
                None => 1.0_f64.copysign(by_place),
            },
            lag: (center.x - self.low.x) / length,
        }
    }

    /// A rim turns with the wheel in which it lies, about the same axle.
    fn inner_discs(&mut self) {
        let wheels: Vec<Actor> = self.parts.iter().copied().collect();
        let wheels = wheels
            .iter()
            .filter(|wheel| wheel.role == Some(Role::Wheel));
        let mut wheels: Vec<&Actor> = wheels.collect();
        wheels.sort_by(|a, b| b.radius.total_cmp(&a.radius));
        for actor in &mut self.parts {
            let around =
                |wheel: &&&Actor| wheel.center.distance(actor.center) < CONCENTRIC * wheel.radius;
            let outer = wheels.iter().find(around);
            if let Some(outer) = outer.filter(|_| actor.role == Some(Role::Wheel)) {
                (actor.radius, actor.center) = (outer.radius, outer.center);
            }
        }
    }

    /// Where no name says tail, the fins at the rear end are one.
    fn fins_as_tails(&mut self) {
        if self.has(Role::Tail) || !self.facing.facing.is_profile() {
            return;
        }
        let forward = self.forward.x;
        let front = if forward > 0.0 {
            self.high.x
        } else {
            self.low.x
        };
        let length = self.length();
        for actor in self.parts.iter_mut() {
            let behind = (front - actor.center.x) * forward;
            if actor.role == Some(Role::Fin) && behind > REAR * length {
                actor.role = Some(Role::Tail);
            }
        }
    }

    fn depths(&mut self, figure: &Figure) {
        let above = |part: &FigurePartId| figure.parts[*part].parent;
        for index in figure.parts.keys() {
            let Some(role) = self.parts[index].role else {
                continue;
            };
            let ways = std::iter::successors(above(&index), above).take(figure.parts.len());
            self.parts[index].depth = ways
                .filter(|part| self.parts[*part].role == Some(role))
                .count();
        }
    }

    /// Whether the root is a pot: it stands on the ground, is not narrow, and others stick out of it.
    fn stands_in_pot(&self, figure: &Figure) -> bool {
        let [low, high] = figure.parts[self.root].bounds;
        let size = high - low;
        let stands = low.y <= self.low.y + 0.05 * self.height();
        stands && size.x > 0.6 * size.y && self.has(Role::Twig)
    }

    fn has(&self, role: Role) -> bool {
        self.parts.iter().any(|actor| actor.role == Some(role))
    }

    fn has_class(&self, class: Class) -> bool {
        let mut labels = self.labels.iter().flatten();
        labels.any(|label| label.class == class)
    }

    pub(super) fn height(&self) -> f64 {
        self.high.y - self.low.y
    }

    pub(super) fn middle(&self) -> DVec2 {
        (self.low + self.high) / 2.0
    }

    /// How long it is along the way that it goes: what faces the viewer is taken to be as long as wide.
    pub(super) fn length(&self) -> f64 {
        self.high.x - self.low.x
    }

    /// The radii of the wheels, the largest first.
    pub(super) fn radii(&self) -> Vec<f64> {
        let wheels = self.parts.iter();
        let wheels = wheels.filter(|actor| actor.role == Some(Role::Wheel) && actor.radius > 0.0);
        let mut radii: Vec<f64> = wheels.map(|actor| actor.radius).collect();
        radii.sort_by(|a, b| b.total_cmp(a));
        radii
    }

    /// What a part is, for people to read: `a wheel`.
    pub(super) fn why(&self, part: FigurePartId) -> String {
        let role = self.parts[part].role.filter(|_| part != self.root);
        match role {
            _ if part == self.root => "the root of the figure".to_owned(),
            Some(Role::Twig) | None => "a part that sticks out".to_owned(),
            Some(role) => format!("a {}", Role::NAMES[role as usize]),
        }
    }

    /// The clip that fits the figure.
    pub(in crate::rig) fn fitting(&self) -> BuiltIn {
        let named_legs = self.has(Role::Leg) && self.is_alive;
        let legs = self
            .parts
            .iter()
            .filter(|actor| actor.role == Some(Role::Leg))
            .count();
        match () {
            () if self.has(Role::Wheel) => BuiltIn::Drive,
            () if self.has(Role::Tentacle) => BuiltIn::Float,
            () if self.is_plant && !named_legs => BuiltIn::Sway,
            () if named_legs || legs > 1 => BuiltIn::Walk,
            () if self.has(Role::Wing) => BuiltIn::Fly,
            () if self.has(Role::Fin) || self.has(Role::Tail) => BuiltIn::Swim,
            () if self.has_class(Class::Arm) && self.is_alive => BuiltIn::Idle,
            () if self.is_alive => BuiltIn::Hop,
            () => BuiltIn::Sway,
        }
    }

    /// Which of the parts that may be the root should be: what stands lowest in what sways, else not a wheel, which rolls.
    pub(in crate::rig) fn better_root(
        &self,
        which: BuiltIn,
        rooted: impl Iterator<Item = FigurePartId>,
        figure: &Figure,
    ) -> Option<FigurePartId> {
        let area = |part: &FigurePartId| {
            let [low, high] = figure.parts[*part].bounds;
            (high - low).element_product()
        };
        let lowest = |part: &FigurePartId| figure.parts[*part].bounds[0].y;
        let found = match which {
            BuiltIn::Sway => rooted.min_by(|a, b| lowest(a).total_cmp(&lowest(b))),
            _ if self.parts[self.root].role == Some(Role::Wheel) => rooted
                .filter(|part| self.parts[*part].role != Some(Role::Wheel))
                .max_by(|a, b| area(a).total_cmp(&area(b))),
            _ => None,
        };
        found.filter(|part| *part != self.root)
    }

    /// What a clip needs that the figure does not have: `wheels`.
    pub(in crate::rig) fn lacks(&self, which: BuiltIn) -> Option<&'static str> {
        let (has, what) = match which {
            BuiltIn::Drive => (self.has(Role::Wheel), "wheels"),
            BuiltIn::Fly => (self.has(Role::Wing), "wings"),
            BuiltIn::Swim => (
                self.has(Role::Fin) || self.has(Role::Tail),
                "fins and no tail",
            ),
            BuiltIn::Float => (self.has(Role::Tentacle), "tentacles"),
            _ => return None,
        };
        (!has).then_some(what)
    }

    /// What it has, for people to read: `2 wheels and a tail`.
    pub(in crate::rig) fn found(&self) -> String {
        let kinds = [
            Role::Wheel,
            Role::Wing,
            Role::Fin,
            Role::Tail,
            Role::Tentacle,
            Role::Leg,
        ];
        let kinds = kinds.into_iter().filter_map(|role| {
            let count = self
                .parts
                .iter()
                .filter(|actor| actor.role == Some(role))
                .count();
            let name = Role::NAMES[role as usize];
            match count {
                0 => None,
                1 => Some(format!("a {name}")),
                count => Some(format!("{count} {name}s")),
            }
        });
        let kinds: Vec<String> = kinds.collect();
        listed(kinds.into_iter())
    }
}

impl Default for Actor {
    fn default() -> Self {
        Self {
            role: None,
            depth: 0,
            span: DVec2::ZERO,
            center: DVec2::ZERO,
            radius: 0.0,
            side: 1.0,
            lag: 0.0,
        }
    }
}

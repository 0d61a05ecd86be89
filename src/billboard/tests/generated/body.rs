//! What the generated characters are made of.

use glam::{DMat3, DVec2, DVec3};

use super::random::Random;
use super::{AROUND, Character, Form, Item, Solid, turn};

/// Points along each side of a rectangular detail.
const ALONG_SIDE: usize = 5;

/// The character of a seed: a trunk, a head and limbs, with a face, clothes and things that differ between seeds. It is 1 high
/// and its bounding box is centred on the origin.
pub(crate) fn character(seed: u64) -> Character {
    let mut build = Build {
        random: Random::new(seed),
        items: Vec::new(),
        solids: Vec::new(),
    };
    build.body();
    let half = |s: &Solid| {
        let rows = s.axes.transpose();
        let extent = |row: DVec3| match s.form {
            Form::Ellipsoid => row.length(),
            Form::Box => row.abs().element_sum(),
        };
        DVec3::new(
            extent(rows.x_axis),
            extent(rows.y_axis),
            extent(rows.z_axis),
        )
    };
    let (low, high) = build
        .solids
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), s| {
            (low.min(s.center - half(s)), high.max(s.center + half(s)))
        });
    let scale = 1.0 / (high.y - low.y);
    for solid in &mut build.solids {
        solid.center = (solid.center - (low + high) / 2.0) * scale;
        solid.axes *= scale;
    }
    Character {
        scale: build.random.between(40.0, 600.0),
        items: build.items,
        solids: build.solids,
    }
}

#[derive(Clone, Copy)]
enum Border {
    Round,
    Rectangle,
}

struct Build {
    random: Random,
    items: Vec<Item>,
    solids: Vec<Solid>,
}

struct Colors {
    skin: [f64; 4],
    hair: [f64; 4],
    cloth: [f64; 4],
    trousers: [f64; 4],
    shoe: [f64; 4],
    dark: [f64; 4],
    accent: [f64; 4],
}

impl Build {
    fn solid(
        &mut self,
        kind: &'static str,
        color: [f64; 4],
        form: Form,
        center: DVec3,
        half: DVec3,
        roll: f64,
    ) -> usize {
        let solid = self.solids.len();
        self.solids.push(Solid {
            form,
            center,
            axes: DMat3::from_rotation_z(roll) * DMat3::from_diagonal(half),
        });
        self.items.push(Item {
            kind,
            color,
            solid,
            detail: None,
        });
        solid
    }

    /// Puts a detail on a solid's front, at a place in the solid's own frame from −1 to 1.
    fn detail(
        &mut self,
        kind: &'static str,
        color: [f64; 4],
        solid: usize,
        at: DVec2,
        half: DVec2,
        border: Border,
    ) {
        let plane: Vec<DVec2> = match border {
            Border::Round => (0..AROUND)
                .map(|i| DVec2::from_angle(turn(i, AROUND)))
                .collect(),
            Border::Rectangle => {
                let corners = [
                    DVec2::new(1.0, 1.0),
                    DVec2::new(-1.0, 1.0),
                    DVec2::new(-1.0, -1.0),
                    DVec2::new(1.0, -1.0),
                ];
                let side = |k: usize| {
                    let along = move |i| {
                        corners[k].lerp(corners[(k + 1) % 4], f64::from(i) / ALONG_SIDE as f64)
                    };
                    (0..ALONG_SIDE as u32).map(along)
                };
                (0..4).flat_map(side).collect()
            }
        };
        let form = self.solids[solid].form;
        let surface = |p: &DVec2| match form {
            Form::Box => (at + *p * half).extend(1.0),
            Form::Ellipsoid => {
                let z = (1.0 - at.length_squared()).max(0.0).sqrt();
                let normal = at.extend(z).normalize();
                let [right, up] = super::tangents(normal);
                (normal + right * (p.x * half.x) + up * (p.y * half.y)).normalize()
            }
        };
        let ring = plane.iter().map(surface).collect();
        self.items.push(Item {
            kind,
            color,
            solid,
            detail: Some(ring),
        });
    }

    /// The same detail on the left and on the right.
    fn pair(
        &mut self,
        kind: &'static str,
        color: [f64; 4],
        solid: usize,
        at: DVec2,
        half: DVec2,
        border: Border,
    ) {
        for side in [1.0, -1.0] {
            let at = DVec2::new(at.x * side, at.y);
            self.detail(kind, color, solid, at, half, border);
        }
    }

    fn body(&mut self) {
        let r = &mut self.random;
        let accent = r.color(0.0, 1.0);
        let mut colors = Colors {
            skin: r.color(0.55, 0.95),
            hair: r.color(0.0, 0.9),
            cloth: r.color(0.1, 0.95),
            trousers: r.color(0.1, 0.8),
            shoe: r.color(0.0, 0.6),
            dark: r.color(0.0, 0.15),
            accent,
        };
        // Drawings have few colours: parts share them.
        if r.chance(0.2) {
            colors.trousers = colors.cloth;
        }
        if r.chance(0.2) {
            colors.shoe = colors.dark;
        }
        if r.chance(0.2) {
            colors.accent = colors.shoe;
        }
        if r.chance(0.1) {
            colors.cloth = colors.skin;
        }
        let half = DVec3::new(
            r.between(0.10, 0.18),
            r.between(0.14, 0.24),
            r.between(0.07, 0.14),
        );
        let radius = r.between(0.13, 0.23);
        let head = DVec3::new(
            radius * r.between(0.9, 1.2),
            radius,
            radius * r.between(0.8, 1.05),
        );
        let center = DVec3::new(0.0, half.y + radius * 0.85, r.between(-0.02, 0.05));
        self.behind(&colors, half, head, center);
        self.legs(&colors, half);
        self.trunk(&colors, half);
        self.arms(&colors, half);
        self.head(&colors, head, center);
    }

    /// What lies behind or beside head and trunk.
    fn behind(&mut self, c: &Colors, trunk: DVec3, head: DVec3, center: DVec3) {
        let form = self.random.form(0.5);
        if self.random.chance(0.15) {
            let half = trunk * DVec3::new(0.8, 0.7, 0.5);
            let at = DVec3::new(0.0, trunk.y * 0.2, -trunk.z * 1.3);
            self.solid("backpack", c.accent, form, at, half, 0.0);
        }
        if self.random.chance(0.25) {
            let side = self.random.between(-1.0, 1.0) * trunk.x;
            let at = DVec3::new(side, -trunk.y * 0.6, -trunk.z * 1.8);
            let half = DVec3::new(0.04, 0.04, 0.12);
            self.solid("tail", c.hair, Form::Ellipsoid, at, half, 0.0);
        }
        if self.random.chance(0.6) {
            let half = head * self.random.between(1.03, 1.15);
            let at = center + DVec3::new(0.0, head.y * 0.15, -head.z * 0.25);
            self.solid("hair behind", c.hair, Form::Ellipsoid, at, half, 0.0);
        }
        let (tails, ears) = (self.random.chance(0.15), self.random.chance(0.55));
        let (size, high) = (
            self.random.between(0.15, 0.3),
            self.random.between(-0.1, 0.9),
        );
        let inner = self.random.chance(0.4);
        for side in [1.0, -1.0] {
            if tails {
                let at = center + DVec3::new(side * head.x * 1.2, -head.y * 0.1, -head.z * 0.3);
                let half = head * DVec3::new(0.22, 0.5, 0.22);
                self.solid("hair tail", c.hair, Form::Ellipsoid, at, half, side * 0.2);
            }
            if ears {
                let across = (1.0 - high * high).sqrt();
                let at = center + DVec3::new(side * across * head.x * 1.02, high * head.y, 0.0);
                let half = head * DVec3::new(size, size * 1.3, size * 0.6);
                let ear = self.solid("ear", c.skin, Form::Ellipsoid, at, half, -side * high * 0.6);
                if inner {
                    let place = DVec2::new(side * 0.1, 0.0);
                    let half = DVec2::splat(0.55);
                    self.detail("inner ear", c.accent, ear, place, half, Border::Round);
                }
            }
        }
    }

    fn legs(&mut self, c: &Colors, trunk: DVec3) {
        let r = &mut self.random;
        let half = DVec3::new(
            trunk.x * r.between(0.28, 0.42),
            r.between(0.08, 0.2),
            trunk.z * r.between(0.4, 0.7),
        );
        let (form, foot_form) = (r.form(0.5), r.form(0.3));
        let (spread, knee, foot) = (r.between(0.0, 0.15), r.chance(0.25), r.chance(0.85));
        let step = if r.chance(0.4) {
            r.between(-0.08, 0.08)
        } else {
            0.0
        };
        for side in [1.0, -1.0] {
            let at = DVec3::new(side * trunk.x * 0.55, -trunk.y - half.y * 0.8, side * step);
            let leg = self.solid("leg", c.trousers, form, at, half, side * spread);
            if knee {
                let half = DVec2::new(0.5, 0.2);
                self.detail("knee", c.accent, leg, DVec2::ZERO, half, Border::Rectangle);
            }
            if foot {
                let at = at + DVec3::new(side * spread * half.y, -half.y, half.z * 0.6);
                let half = DVec3::new(half.x * 1.2, 0.035, half.z * 1.6);
                self.solid("foot", c.shoe, foot_form, at, half, 0.0);
            }
        }
    }

    fn trunk(&mut self, c: &Colors, half: DVec3) {
        let form = self.random.form(0.4);
        let trunk = self.solid("trunk", c.cloth, form, DVec3::ZERO, half, 0.0);
        let reach = if form == Form::Box { 1.0 } else { 0.75 };
        let r = &mut self.random;
        let (belly, pockets, badge, belt) =
            (r.chance(0.2), r.chance(0.3), r.chance(0.25), r.chance(0.25));
        let buttons = if r.chance(0.6) { 1 + r.below(5) } else { 0 };
        let (size, top) = (r.between(0.05, 0.11), r.between(0.4, 0.7));
        let beside = r.between(-0.15, 0.15);
        if belly {
            let half = DVec2::splat(0.55 * reach);
            self.detail("belly", c.skin, trunk, DVec2::ZERO, half, Border::Round);
        }
        if belt {
            let (at, half) = (DVec2::new(0.0, -0.7 * reach), DVec2::new(0.6 * reach, 0.07));
            self.detail("belt", c.dark, trunk, at, half, Border::Rectangle);
        }
        for i in 0..buttons {
            let along = i as f64 / buttons as f64;
            let at = DVec2::new(beside, (top - along * (top + 0.55)) * reach);
            let half = DVec2::new(size * half.y / half.x, size);
            self.detail("button", c.accent, trunk, at, half, Border::Round);
        }
        if pockets {
            let (at, half) = (DVec2::new(0.5, -0.35) * reach, DVec2::new(0.2, 0.14));
            self.pair("pocket", c.trousers, trunk, at, half, Border::Rectangle);
        }
        if badge {
            let at = DVec2::new(0.45, 0.45) * reach;
            self.detail(
                "badge",
                c.hair,
                trunk,
                at,
                DVec2::splat(0.13),
                Border::Round,
            );
        }
    }

    fn arms(&mut self, c: &Colors, trunk: DVec3) {
        let r = &mut self.random;
        let length = r.between(0.1, 0.18);
        let thick = length * r.between(0.25, 0.45);
        let (form, cuff, tool) = (r.form(0.25), r.chance(0.2), r.chance(0.1));
        let both = r.between(0.1, 1.2);
        for side in [1.0, -1.0] {
            let r = &mut self.random;
            let angle: f64 = if r.chance(0.4) {
                r.between(0.0, 2.6)
            } else {
                both
            };
            let forward = if r.chance(0.3) {
                r.between(-0.1, 0.12)
            } else {
                0.0
            };
            let down = DVec3::new(side * angle.sin(), -angle.cos(), 0.0);
            let shoulder = DVec3::new(side * (trunk.x + thick * 0.3), trunk.y * 0.65, forward);
            let at = shoulder + down * length * 0.9;
            let half = DVec3::new(thick, length, thick);
            let arm = self.solid("arm", c.cloth, form, at, half, side * angle);
            if cuff {
                let (place, half) = (DVec2::new(0.0, -0.6), DVec2::new(0.5, 0.1));
                self.detail("cuff", c.accent, arm, place, half, Border::Rectangle);
            }
            let hand = shoulder + down * length * 1.95;
            let half = DVec3::splat(thick * 1.15);
            self.solid("hand", c.skin, Form::Ellipsoid, hand, half, 0.0);
            if tool && side > 0.0 {
                let at = hand + DVec3::new(0.0, 0.1, thick);
                let half = DVec3::new(0.015, 0.14, 0.015);
                self.solid("tool", c.shoe, Form::Box, at, half, 0.1);
            }
        }
    }

    fn head(&mut self, c: &Colors, half: DVec3, center: DVec3) {
        let form = self.random.form(0.15);
        let head = self.solid("head", c.skin, form, center, half, 0.0);
        let r = &mut self.random;
        let white = [0.97, 0.97, 0.97, 1.0];
        let (fringe, brows, cheeks, freckles) =
            (r.chance(0.5), r.chance(0.6), r.chance(0.4), r.chance(0.12));
        let (has_white, glint, mark) = (r.chance(0.6), r.chance(0.4), r.chance(0.2));
        let eye = DVec2::new(r.between(0.28, 0.48), r.between(-0.05, 0.25));
        let size = DVec2::new(r.between(0.08, 0.17), r.between(0.1, 0.2));
        let gaze = DVec2::new(r.between(-0.04, 0.04), r.between(-0.03, 0.03));
        let mouth = DVec2::new(r.between(0.1, 0.35), r.between(0.03, 0.12));
        let (nose, hat) = (r.below(3), r.chance(0.3));
        let iris = if r.chance(0.5) { c.dark } else { c.accent };
        if fringe && form == Form::Ellipsoid {
            let (at, half) = (DVec2::new(0.0, 0.95), DVec2::splat(1.1));
            self.detail("fringe", c.hair, head, at, half, Border::Round);
        }
        if has_white {
            self.pair("eye", white, head, eye, size, Border::Round);
        }
        let ratio = if has_white { 0.5 } else { 0.7 };
        for side in [1.0, -1.0] {
            let at = DVec2::new(side * eye.x, eye.y) + gaze;
            self.detail("pupil", iris, head, at, size * ratio, Border::Round);
            if glint {
                let at = at + size * ratio * 0.3;
                self.detail("glint", white, head, at, size * ratio * 0.35, Border::Round);
            }
        }
        if brows {
            let (at, half) = (eye + DVec2::new(0.0, 0.3), DVec2::new(0.16, 0.035));
            self.pair("brow", c.hair, head, at, half, Border::Rectangle);
        }
        if cheeks {
            let (at, pink) = (DVec2::new(0.55, -0.25), [0.95, 0.55, 0.6, 1.0]);
            self.pair(
                "cheek",
                pink,
                head,
                at,
                DVec2::new(0.13, 0.09),
                Border::Round,
            );
        }
        if freckles {
            for at in [DVec2::new(0.38, -0.15), DVec2::new(0.5, -0.1)] {
                self.pair(
                    "freckle",
                    c.dark,
                    head,
                    at,
                    DVec2::splat(0.03),
                    Border::Round,
                );
            }
        }
        if mark {
            let at = DVec2::new(self.random.between(-0.4, 0.4), 0.62);
            self.detail("mark", c.accent, head, at, DVec2::splat(0.1), Border::Round);
        }
        let at = DVec2::new(0.0, -0.5);
        let red = [0.75, 0.2, 0.2, 1.0];
        self.detail("mouth", red, head, at, mouth, Border::Round);
        match nose {
            0 => {
                let half = DVec2::new(0.07, 0.06);
                self.detail(
                    "nose",
                    c.dark,
                    head,
                    DVec2::new(0.0, -0.15),
                    half,
                    Border::Round,
                );
            }
            1 => {
                let at = center + DVec3::new(0.0, -0.12 * half.y, half.z);
                let half = DVec3::splat(half.y * 0.12);
                self.solid("nose", red, Form::Ellipsoid, at, half, 0.0);
            }
            _ => {}
        }
        if hat {
            let top = center + DVec3::Y * half.y;
            let brim = half * DVec3::new(1.2, 0.1, 1.2);
            let crown = half * DVec3::new(0.7, 0.45, 0.7);
            let form = self.random.form(0.4);
            let at = top - DVec3::Y * half.y * 0.25;
            self.solid("brim", c.accent, Form::Ellipsoid, at, brim, 0.0);
            let at = top + DVec3::new(0.0, half.y * 0.1, 0.01);
            let crown = self.solid("crown", c.accent, form, at, crown, 0.0);
            let place = DVec2::new(0.0, 0.1);
            self.detail(
                "hat badge",
                c.cloth,
                crown,
                place,
                DVec2::splat(0.2),
                Border::Round,
            );
        }
    }
}

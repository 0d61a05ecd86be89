//! Settings of the whole drawing, from its `%` strings.

use glam::{DMat3, DQuat, DVec2, DVec3};

use super::nearest::DistanceMode;
use crate::bind::bindings::StringId;
use crate::lang::keyword::Keyword;
use crate::lang::value::{Ground, Setting, Value};
use crate::svg::Drawing;

/// The settings of a drawing, with their defaults filled in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawingSettings {
    /// `Scale`: centimetres in a drawing unit.
    pub scale: f64,
    /// `Axes`: from the drawing's right, its up and the viewer's direction to the world's axes.
    pub axes: DQuat,
    /// `Ground`: the point of the drawing at the world's origin; `None` for the middle of the lower edge of all that is built.
    pub ground: Option<DVec2>,
    /// `Bind`: how strings find their parts.
    pub bind: BindRule,
    /// `Strokes`: which strokes are built.
    pub strokes: Strokes,
}

/// How a string finds its part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BindRule {
    /// It belongs to the part that it lies on, else to one near it.
    Meant,
    /// It belongs to the nearest part, as in the paper.
    Nearest(DistanceMode),
}

/// Which strokes are built. Those with a string of their own are parts in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strokes {
    /// None.
    None,
    /// Those of unfilled shapes that lie on a part, as ink on it, and those that have a name or begin on a part. What a drawing gets that
    /// says `Shape` but not `Strokes`.
    Ink,
    /// Those of unfilled shapes: as ink where they lie on a part, else as parts.
    Lines,
    /// All: outlines of filled shapes too, as ink on these.
    All,
    /// All but hairlines beside all shapes, which are guides. What a drawing gets whose strings are about parts, but say neither `Shape`
    /// nor `Strokes`.
    Visible,
}

impl Default for DrawingSettings {
    /// The settings of a drawing without strings about parts, in which hairlines are parts too.
    fn default() -> Self {
        Self {
            scale: 1.0,
            axes: DQuat::IDENTITY,
            ground: None,
            bind: BindRule::Meant,
            strokes: Strokes::All,
        }
    }
}

/// Metres in a centimetre.
const CENTIMETER: f64 = 0.01;

impl DrawingSettings {
    /// Metres in a drawing unit.
    pub fn meters(&self) -> f64 {
        self.scale * CENTIMETER
    }

    /// The settings of a drawing with strings. `strokes` are built unless a string says which.
    pub(super) fn read(
        drawing: &Drawing,
        defaults: &[(StringId, Setting)],
        strokes: Strokes,
    ) -> Self {
        let mut settings = Self {
            strokes,
            ..Self::default()
        };
        for (_, setting) in defaults {
            match (setting.keyword, &setting.value) {
                (Keyword::Scale, Value::Number(scale)) => settings.scale = *scale,
                (Keyword::Axes, Value::Axes(axes)) => {
                    let [right, up, front] = axes.map(|axis| {
                        let mut vector = [0.0; 3];
                        vector[axis.axis] = if axis.negative { -1.0 } else { 1.0 };
                        DVec3::from(vector)
                    });
                    // Left-handed axes are refused where strings are checked.
                    settings.axes = DQuat::from_mat3(&DMat3::from_cols(right, up, front));
                }
                (Keyword::Ground, Value::Ground(ground)) => {
                    settings.ground = match ground {
                        Ground::Bottom => None,
                        Ground::Page => Some(drawing.page.0),
                        Ground::Point([x, y]) => Some(DVec2::new(*x, *y)),
                    };
                }
                (Keyword::Bind, Value::Word(word)) => {
                    settings.bind = match word.to_lowercase().as_str() {
                        "center" => BindRule::Nearest(DistanceMode::Center),
                        "outline" => BindRule::Nearest(DistanceMode::Outline),
                        _ => BindRule::Meant,
                    };
                }
                (Keyword::Strokes, Value::Word(word)) => {
                    settings.strokes = match word.to_lowercase().as_str() {
                        "lines" => Strokes::Lines,
                        "all" => Strokes::All,
                        _ => Strokes::None,
                    };
                }
                _ => {}
            }
        }
        settings
    }
}

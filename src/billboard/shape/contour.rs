//! Contours by arc length.

use crate::math;
use glam::DVec2;

/// Turns from this angle on are corners, radians.
const CORNER: f64 = 0.6;
/// The length before and after a vertex over which it turns, relative to the contour's.
const CORNER_WINDOW: f64 = 0.01;

/// Whether a contour runs back to its first point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ends {
    /// A ring.
    Joined,
    /// A line with two ends.
    Free,
}

/// A line through points, by the share of its length.
#[derive(Debug, Clone)]
pub(super) struct Contour {
    pub(super) points: Vec<DVec2>,
    /// The length up to each point, relative to the whole. A ring has one more for its end.
    at: Vec<f64>,
    pub(super) ends: Ends,
}

impl Contour {
    /// `None` if the points are all the same.
    pub(super) fn new(points: &[DVec2], ends: Ends) -> Option<Self> {
        let mut points = points.to_vec();
        points.dedup();
        if ends == Ends::Joined {
            points.extend(points.first().copied());
        }
        let mut at = vec![0.0];
        let mut length = 0.0;
        for edge in points.windows(2) {
            length += edge[0].distance(edge[1]);
            at.push(length);
        }
        if !(length > 0.0 && length.is_finite()) {
            return None;
        }
        for at in &mut at {
            *at /= length;
        }
        if ends == Ends::Joined {
            points.pop();
        }
        Some(Self { points, at, ends })
    }

    /// The places of the vertices, from 0 to 1, ascending.
    pub(super) fn vertices(&self) -> &[f64] {
        &self.at[..self.points.len()]
    }

    /// The point at a place. Places wrap around rings and are clamped on lines.
    pub(super) fn point(&self, place: f64) -> DVec2 {
        let place = match self.ends {
            Ends::Joined => place.rem_euclid(1.0),
            Ends::Free => place.clamp(0.0, 1.0),
        };
        let count = self.points.len();
        let after = self.at.partition_point(|at| *at <= place);
        let from = after.clamp(1, self.at.len() - 1) - 1;
        let (a, b) = (
            self.points[from],
            self.points[if from + 1 < count { from + 1 } else { 0 }],
        );
        let length = self.at[from + 1] - self.at[from];
        if length > 0.0 {
            a.lerp(b, ((place - self.at[from]) / length).min(1.0))
        } else {
            a
        }
    }

    /// The place nearest to a point, and the distance.
    pub(super) fn nearest(&self, point: DVec2) -> (f64, f64) {
        let mut nearest = (0.0, f64::INFINITY);
        for from in 0..self.at.len() - 1 {
            let a = self.points[from];
            let b = self.points[(from + 1) % self.points.len()];
            let edge = b - a;
            let along = (point - a).dot(edge) / edge.length_squared();
            let along = if along.is_finite() {
                along.clamp(0.0, 1.0)
            } else {
                0.0
            };
            let distance = (a + edge * along).distance(point);
            if distance < nearest.1 {
                let place = self.at[from] + along * (self.at[from + 1] - self.at[from]);
                nearest = (place, distance);
            }
        }
        nearest
    }

    /// Places of the corners with the angles by which they turn, radians.
    pub(super) fn corners(&self) -> Vec<(f64, f64)> {
        let turns: Vec<f64> = self.vertices().iter().map(|at| self.turn(*at)).collect();
        let vertices = self.vertices();
        let mut corners: Vec<(f64, f64)> = Vec::new();
        for (&at, &turn) in vertices.iter().zip(&turns) {
            if turn.abs() < CORNER {
                continue;
            }
            match corners.last_mut() {
                // Only the sharpest of those within a window.
                Some(last) if at - last.0 < CORNER_WINDOW => {
                    if turn.abs() > last.1.abs() {
                        *last = (at, turn);
                    }
                }
                _ => corners.push((at, turn)),
            }
        }
        corners
    }

    /// The angle by which the contour turns near a place, radians.
    pub(super) fn turn(&self, at: f64) -> f64 {
        let here = self.point(at);
        let (before, after) = (
            here - self.point(at - CORNER_WINDOW),
            self.point(at + CORNER_WINDOW) - here,
        );
        math::atan2(before.perp_dot(after), before.dot(after))
    }
}

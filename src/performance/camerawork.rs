//! Camerawork: a camera that follows the emphasised joint, first nearer, then farther away (Manya & Matsuda, section 3.3.3).

use glam::DVec3;

use crate::math;
use crate::smoothing::ease;

/// The vertical field of view of the camera, radians: that of an 85 mm lens on a square of 36 mm.
pub(crate) const CAMERA_FOV: f64 = 0.417_4;
/// How much of the distance is left where the camera is nearest.
const NEAREST: f64 = 0.5;
/// The empty border around the figure where the camera is farthest, as a share of the picture.
const MARGIN: f64 = 0.08;

/// The path of a camera that looks along a fixed direction.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CameraPath {
    /// Per frame its position, in the unit and the axes of the joint's.
    pub positions: Vec<DVec3>,
    /// Per frame its distance from the joint.
    pub distances: Vec<f64>,
    /// The frame in which it is nearest.
    pub nearest: usize,
}

/// The path of a camera for a joint that is at these positions, frame by frame. `front` points from the figure to the viewer, a unit
/// vector; `reach` is how far the figure reaches from the joint at a right angle to it, and `depth` how far along it.
///
/// The camera comes nearer until the frame in which the joint is nearest to the viewer (of equal ones the first), to half its distance,
/// and then goes back. The joint is always in the middle of the picture; where the camera is farthest, all of the figure is in it.
pub(crate) fn camerawork(joint: &[DVec3], front: DVec3, reach: f64, depth: f64) -> CameraPath {
    let mut nearest = (0, f64::NEG_INFINITY);
    for (frame, at) in joint.iter().enumerate() {
        let height = at.dot(front);
        if height > nearest.1 {
            nearest = (frame, height);
        }
    }
    let nearest = nearest.0;
    let tangent = math::tan(CAMERA_FOV / 2.0) * (1.0 - MARGIN);
    // The camera is in front of the figure where it is nearest, too.
    let far = (reach / tangent + depth).max(depth * 1.5 / NEAREST);
    let last = joint.len().saturating_sub(1);
    let distance = |frame: usize| {
        let away = if frame <= nearest {
            (nearest - frame) as f64 / nearest.max(1) as f64
        } else {
            (frame - nearest) as f64 / (last - nearest) as f64
        };
        far * (NEAREST + (1.0 - NEAREST) * ease(away))
    };
    let distances: Vec<f64> = (0..joint.len()).map(distance).collect();
    let positions = joint.iter().zip(&distances);
    CameraPath {
        positions: positions
            .map(|(at, distance)| *at + front * *distance)
            .collect(),
        distances,
        nearest,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_comes_nearer_and_goes_back() {
        let joint: Vec<DVec3> = (0..40)
            .map(|frame| {
                let t = f64::from(frame);
                DVec3::new(t, (t * 0.3).sin(), 30.0 - (t - 12.0).abs())
            })
            .collect();
        let path = camerawork(&joint, DVec3::Z, 5.0, 2.0);
        assert_eq!(path.nearest, 12);
        assert!(path.distances[..13].windows(2).all(|d| d[0] > d[1]));
        assert!(path.distances[12..].windows(2).all(|d| d[0] < d[1]));
        assert_eq!(path.distances[12] * 2.0, path.distances[0]);
        assert_eq!(path.distances[0], path.distances[39]);
        for (camera, joint) in path.positions.iter().zip(&joint) {
            assert_eq!([camera.x, camera.y], [joint.x, joint.y]);
            // All of the figure is in the picture, seen from afar.
        }
        assert!(path.distances[0] * (CAMERA_FOV / 2.0).tan() > 5.0);
        assert!(path.distances[12] > 2.0);
    }

    #[test]
    fn at_an_end_there_is_one_phase() {
        let approaching: Vec<DVec3> = (0..10).map(|t| DVec3::Z * f64::from(t)).collect();
        let path = camerawork(&approaching, DVec3::Z, 1.0, 1.0);
        assert!(path.distances.windows(2).all(|d| d[0] > d[1]));
        let path = camerawork(&approaching, DVec3::NEG_Z, 1.0, 1.0);
        assert!(path.distances.windows(2).all(|d| d[0] < d[1]));
        let still = camerawork(&[DVec3::ONE; 3], DVec3::Z, 1.0, 1.0);
        assert_eq!(still.nearest, 0);
        assert_eq!(camerawork(&[], DVec3::Z, 1.0, 1.0), CameraPath::default());
        let single = camerawork(&[DVec3::ONE], DVec3::Z, 1.0, 1.0);
        assert!(single.distances[0].is_finite());
    }
}

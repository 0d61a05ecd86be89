//! Vehicles drawn from the side with names alone are as deep as toys, and stand on wheels on both sides.

mod common;

use common::law;
use okoshi::compile::{Compiled, Options, compile};
use okoshi::export::{GLB, to_memory};
use okoshi::resolver::MemoryResolver;
use proptest::prelude::*;

/// A box on wheels.
#[derive(Debug, Clone)]
struct Vehicle {
    /// Its width and height without wheels.
    size: [u32; 2],
    /// The radius of its wheels, as a share of its height.
    radius: f64,
    wheels: u32,
    /// Whether its corners are round.
    is_round: bool,
    /// Whether the wheels are drawn before the body.
    is_covered: bool,
}

fn vehicle() -> impl Strategy<Value = Vehicle> {
    let size = (200..400_u32, 80..160_u32);
    (size, 0.1..0.25_f64, 2..6_u32, any::<[bool; 2]>()).prop_map(
        |((width, height), radius, wheels, [is_round, is_covered])| Vehicle {
            size: [width, height],
            radius,
            wheels,
            is_round,
            is_covered,
        },
    )
}

impl Vehicle {
    /// Its drawing.
    fn drawing(&self) -> String {
        let [width, height] = self.size;
        let radius = self.radius * f64::from(height);
        let round = if self.is_round { height / 2 } else { 0 };
        let body = format!(
            r##"<rect id="Body" x="20" y="20" width="{width}" height="{height}" rx="{round}" fill="#c03020"/>"##
        );
        let room = f64::from(width) - 4.0 * radius;
        let wheel = |place: u32| {
            let x = 20.0 + 2.0 * radius + room * f64::from(place) / f64::from(self.wheels - 1);
            format!(
                r##"<circle id="Wheel_{place}" cx="{x}" cy="{}" r="{radius}" fill="#222222"/>"##,
                20 + height
            )
        };
        let wheels: String = (0..self.wheels).map(wheel).collect();
        let [first, second] = if self.is_covered {
            [wheels, body]
        } else {
            [body, wheels]
        };
        format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="440" height="240">{first}{second}</svg>"#
        )
    }
}

fn compiled(drawing: &str) -> Compiled {
    compile(drawing, &Options::default(), &MemoryResolver::default())
}

/// How deep a model is, over its width.
fn depth(compiled: &Compiled) -> f64 {
    let model = to_memory(&GLB, &compiled.scene, None).expect("a model");
    let size = model.written.size.expect("a size");
    size.depth / size.width
}

#[test]
fn vehicles_are_as_deep_as_toys() {
    law::check(law::config(48), 90, vehicle(), |vehicle| {
        let depth = depth(&compiled(&vehicle.drawing()));
        prop_assert!((0.2..=0.6).contains(&depth), "{depth}");
        Ok(true)
    });
}

#[test]
fn wheels_are_the_same_on_both_sides() {
    law::check(law::config(48), 90, vehicle(), |vehicle| {
        let nodes = common::nodes(&common::glb(&compiled(&vehicle.drawing())));
        let nodes = nodes.map_err(TestCaseError::fail)?;
        let wheels = nodes.iter().filter(|node| node.name.starts_with("Wheel"));
        let mut count = 0;
        for wheel in wheels {
            let depths = wheel.primitives.iter().flat_map(|one| &one.positions);
            let depths: Vec<f32> = depths.map(|at| at[2]).collect();
            let [low, high] = [f32::min, f32::max].map(|most| depths.iter().copied().reduce(most));
            let (low, high) = (low.unwrap_or_default(), high.unwrap_or_default());
            prop_assert!(high > 0.0 && (low + high).abs() <= 1e-5, "{low} {high}");
            // Nothing of it is in the middle, where both discs would be one.
            let nearest = depths.iter().map(|depth| depth.abs()).fold(high, f32::min);
            prop_assert!(nearest > 0.2 * high, "{nearest} {high}");
            count += 1;
        }
        prop_assert_eq!(count, vehicle.wheels);
        Ok(true)
    });
}

#[test]
fn a_shape_in_a_string_takes_it_all_back() {
    let vehicle = Vehicle {
        size: [300, 120],
        radius: 0.2,
        wheels: 3,
        is_round: false,
        is_covered: false,
    };
    let drawing = vehicle.drawing();
    let plates = drawing.replace("</svg>", "<text y=\"230\">%Shape default</text></svg>");
    assert!(depth(&compiled(&drawing)) > 0.2);
    assert!(depth(&compiled(&plates)) < 0.2);
}

//! From the light that arrives to the light that is seen.

use glam::{Vec3, Vec4};

use super::fragment::{Fragment, Matter, ground_fade};
use super::light::{Arriving, Rig, open_sky, sky};
use super::surface::Material;
use super::trace::Tracer;

/// What a surface that is no metal mirrors when it is looked at squarely.
const MIRRORED: f32 = 0.04;
/// Light up to here is shown as it is; what is brighter is bent to stay below 1.
const SHOULDER: f32 = 0.6;
/// The darkest shadow on the ground.
const SHADOW: f32 = 0.62;

/// Colour times alpha, and alpha, of a piece; its weight is not in it yet.
pub(super) fn shade(
    fragment: &Fragment,
    arriving: &Arriving,
    tracer: &Tracer<'_>,
    rig: &Rig,
) -> Vec4 {
    match fragment.matter {
        Matter::Ground => {
            let fade = ground_fade(fragment.place, &tracer.surface);
            Vec4::new(0.0, 0.0, 0.0, shadow(arriving, rig) * fade)
        }
        Matter::Of(material) => {
            let material = &tracer.materials[material];
            let light = match material.unlit {
                true => fragment.colour,
                false => bent(lit(fragment, material, arriving, rig)),
            };
            light.extend(1.0)
        }
    }
}

/// How dark the ground is, 0 where nothing stands.
fn shadow(arriving: &Arriving, rig: &Rig) -> f32 {
    let key = rig.strength(0) * rig.directions[0].y;
    let sky = rig.sky_strength();
    let light = (key * arriving.lamps[0] + sky * arriving.sky / open_sky(Vec3::Y)) / (key + sky);
    // The last trace is left out, so that clear pixels stay quite clear.
    ((1.0 - light) * 1.05 - 0.05).clamp(0.0, 1.0) * SHADOW
}

fn lit(fragment: &Fragment, material: &Material, arriving: &Arriving, rig: &Rig) -> Vec3 {
    let normal = fragment.normal;
    let towards = fragment.towards;
    let metal = material.metallic.clamp(0.0, 1.0);
    let roughness = material.roughness.clamp(0.05, 1.0);
    let dull = fragment.colour * (1.0 - metal);
    let squarely = Vec3::splat(MIRRORED).lerp(fragment.colour, metal);
    let facing = normal.dot(towards).clamp(0.001, 1.0);

    let open = (arriving.sky / open_sky(normal)).clamp(0.0, 1.0);
    let mut light = dull * bounced(open, dull) * open_sky(normal) * rig.sky_strength();
    for lamp in 0..3 {
        let strength = rig.on(lamp, normal, arriving);
        if strength > 0.0 {
            light += dull * strength;
            let gloss = gloss(normal, towards, rig.directions[lamp], roughness.max(0.2));
            light += fresnel(squarely, towards, rig.directions[lamp]) * gloss * strength;
        }
    }
    let mirrored =
        (2.0 * normal * normal.dot(towards) - towards).lerp(normal, roughness * roughness);
    let (scale, bias) = surroundings(roughness, facing);
    light += (squarely * scale + bias)
        * sky(mirrored.normalize_or(normal))
        * rig.sky_strength()
        * open
        * 1.6;
    light + material.emissive
}

/// How much light there is in a hollow, where surfaces of that colour give light to each other (Jimenez and others
/// 2016).
fn bounced(open: f32, colour: Vec3) -> Vec3 {
    let colour = colour.clamp(Vec3::ZERO, Vec3::ONE);
    let a = 2.0404 * colour - 0.3324;
    let b = -4.7951 * colour + 0.6417;
    let c = 2.7552 * colour + 0.6903;
    (((a * open + b) * open + c) * open).max(Vec3::splat(open))
}

/// The highlight of a lamp over the lamp's own light (GGX, visibility after Karis 2013), capped: lamps have a size.
fn gloss(normal: Vec3, towards: Vec3, lamp: Vec3, roughness: f32) -> f32 {
    let half = (towards + lamp).normalize_or(normal);
    let alpha = roughness * roughness;
    let cosine = normal.dot(half).max(0.0);
    let below = cosine * cosine * (alpha * alpha - 1.0) + 1.0;
    let density = alpha * alpha / (std::f32::consts::PI * below * below);
    let k = (roughness + 1.0) * (roughness + 1.0) / 8.0;
    let seen = |cosine: f32| cosine * (1.0 - k) + k;
    let visible = 0.25 / (seen(normal.dot(towards).max(0.0)) * seen(normal.dot(lamp).max(0.0)));
    (density * visible * std::f32::consts::PI).min(12.0)
}

fn fresnel(squarely: Vec3, towards: Vec3, lamp: Vec3) -> Vec3 {
    let half = (towards + lamp).normalize_or(towards);
    let grazing = (1.0 - half.dot(towards).clamp(0.0, 1.0)).powi(5);
    squarely + (Vec3::ONE - squarely) * grazing
}

/// What a surface mirrors of its surroundings: a factor and a summand (Karis 2014).
fn surroundings(roughness: f32, facing: f32) -> (f32, f32) {
    let x = 1.0 - roughness;
    let y = roughness * -0.0275 + 0.0425;
    let z = roughness * -0.572 + 1.04;
    let w = roughness * 0.022 - 0.04;
    let edge = (x * x).min((-9.28 * facing).exp2()) * x + y;
    (edge * -1.04 + z, edge * 1.04 + w)
}

/// Keeps bright light below 1 without changing its hue.
fn bent(light: Vec3) -> Vec3 {
    let most = light.max_element();
    if most <= SHOULDER {
        return light.max(Vec3::ZERO);
    }
    let room = 1.0 - SHOULDER;
    light * ((SHOULDER + room * (1.0 - (-(most - SHOULDER) / room).exp())) / most)
}

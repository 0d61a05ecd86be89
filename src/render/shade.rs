//! Shading: from incident light to the colour of a fragment.

use crate::math;
use glam::Vec3;

use super::fragment::Fragment;
use super::light::{IncidentLight, Lights, open_sky, sky};
use super::surface::Material;

/// The reflectance of a dielectric at normal incidence.
const DIELECTRIC_REFLECTANCE: f32 = 0.04;
/// Light up to here is unchanged; brighter light is compressed to stay below 1.
const SHOULDER: f32 = 0.6;
/// The darkest shadow on the ground.
const SHADOW: f32 = 0.62;

/// The colour of a fragment of the model.
pub(super) fn shade(
    fragment: &Fragment,
    material: &Material,
    incident: &IncidentLight,
    lights: &Lights,
) -> Vec3 {
    if material.unlit {
        fragment.color
    } else {
        tone_mapped(lit(fragment, material, incident, lights))
    }
}

/// The share of the light that reaches the ground, 0 to 1.
pub(super) fn ground_light(incident: &IncidentLight, lights: &Lights) -> f32 {
    let key = lights.strength(0) * lights.directions[0].y;
    let sky = lights.sky_strength();
    (key * incident.lamps[0] + sky * incident.sky / open_sky(Vec3::Y)) / (key + sky)
}

/// The opacity of the ground's shadow where this share of the light reaches it, 0 in full light.
#[inline]
pub(super) fn shadow(light: f32) -> f32 {
    // The faintest shadow is cut off, so that the background stays fully transparent.
    ((1.0 - light) * 1.05 - 0.05).clamp(0.0, 1.0) * SHADOW
}

fn lit(
    fragment: &Fragment,
    material: &Material,
    incident: &IncidentLight,
    lights: &Lights,
) -> Vec3 {
    let normal = fragment.normal;
    let towards = fragment.towards;
    let metal = material.metallic.clamp(0.0, 1.0);
    let roughness = material.roughness.clamp(0.05, 1.0);
    let dull = fragment.color * (1.0 - metal);
    let reflectance = Vec3::splat(DIELECTRIC_REFLECTANCE).lerp(fragment.color, metal);
    let facing = normal.dot(towards).clamp(0.001, 1.0);

    let open = (incident.sky / open_sky(normal)).clamp(0.0, 1.0);
    let mut light =
        dull * multi_bounce_occlusion(open, dull) * open_sky(normal) * lights.sky_strength();
    for lamp in 0..3 {
        let strength = lights.on(lamp, normal, incident);
        if strength > 0.0 {
            light += dull * strength;
            let gloss = gloss(normal, towards, lights.directions[lamp], roughness.max(0.2));
            light += fresnel(reflectance, towards, lights.directions[lamp]) * gloss * strength;
        }
    }
    let mirrored =
        (2.0 * normal * normal.dot(towards) - towards).lerp(normal, roughness * roughness);
    let (scale, bias) = environment_brdf(roughness, facing);
    light += (reflectance * scale + bias)
        * sky(mirrored.normalize_or(normal))
        * lights.sky_strength()
        * open
        * 1.6;
    light + material.emissive
}

/// Ambient occlusion with light that bounces between surfaces of the same colour (Jimenez and others 2016).
fn multi_bounce_occlusion(open: f32, color: Vec3) -> Vec3 {
    let color = color.clamp(Vec3::ZERO, Vec3::ONE);
    let a = 2.0404 * color - 0.3324;
    let b = -4.7951 * color + 0.6417;
    let c = 2.7552 * color + 0.6903;
    (((a * open + b) * open + c) * open).max(Vec3::splat(open))
}

/// The highlight of a lamp relative to its diffuse light (GGX, visibility after Karis 2013), capped because lamps have a
/// size.
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

fn fresnel(reflectance: Vec3, towards: Vec3, lamp: Vec3) -> Vec3 {
    let half = (towards + lamp).normalize_or(towards);
    let grazing = (1.0 - half.dot(towards).clamp(0.0, 1.0)).powi(5);
    reflectance + (Vec3::ONE - reflectance) * grazing
}

/// The reflection of the environment: a factor and an offset for the reflectance (Karis 2014).
fn environment_brdf(roughness: f32, facing: f32) -> (f32, f32) {
    let x = 1.0 - roughness;
    let y = roughness * -0.0275 + 0.0425;
    let z = roughness * -0.572 + 1.04;
    let w = roughness * 0.022 - 0.04;
    let edge = (x * x).min(math::exp2(-9.28 * facing)) * x + y;
    (edge * -1.04 + z, edge * 1.04 + w)
}

/// Compresses bright light to stay below 1 without changing its hue.
fn tone_mapped(light: Vec3) -> Vec3 {
    let most = light.max_element();
    if most <= SHOULDER {
        return light.max(Vec3::ZERO);
    }
    let room = 1.0 - SHOULDER;
    light * ((SHOULDER + room * (1.0 - math::exp(-(most - SHOULDER) / room))) / most)
}

use super::*;

/// A PNG of noise, `side` pixels wide and high.
fn noise(side: u32, seed: u64) -> Arc<[u8]> {
    let mut random = fastrand::Rng::with_seed(seed);
    let picture =
        image::RgbaImage::from_fn(side, side, |_, _| image::Rgba(random.u32(..).to_le_bytes()));
    let mut out = io::Cursor::new(vec![]);
    picture.write_to(&mut out, image::ImageFormat::Png).unwrap();
    out.into_inner().into()
}

/// A scene with a texture in every place of its material.
pub(super) fn scene(mut surface: Surface, side: u32) -> Scene {
    surface.uvs = surface.positions.iter().map(|p| [p[0], p[1]]).collect();
    let mut scene = single(surface);
    let image = |name: &str, bytes: Arc<[u8]>| Image {
        name: name.to_owned(),
        media_type: MediaType::Png,
        bytes,
    };
    let jpeg = image::RgbImage::from_pixel(9, 5, image::Rgb([200, 30, 0]));
    let mut out = io::Cursor::new(vec![]);
    jpeg.write_to(&mut out, image::ImageFormat::Jpeg).unwrap();
    scene.images = ti_vec![
        image("cloth", noise(side, 1)),
        image("cloth again", noise(side, 1)),
        image("metal \"2\"", noise(8, 2)),
        Image {
            media_type: MediaType::Jpeg,
            ..image("shade", out.into_inner().into())
        },
    ];
    let texture = |image: usize, wrap, filter| Texture {
        image: image.into(),
        wrap,
        filter,
    };
    scene.textures = ti_vec![
        texture(0, [Wrap::ClampToEdge; 2], Filter::Linear),
        texture(1, [Wrap::ClampToEdge; 2], Filter::Linear),
        texture(2, [Wrap::Repeat, Wrap::MirroredRepeat], Filter::Nearest),
        texture(3, [Wrap::Repeat; 2], Filter::Linear),
        texture(2, [Wrap::Repeat; 2], Filter::Linear),
    ];
    scene.materials.push(Material {
        base_color_texture: Some(TextureUse::new(0.into())),
        metallic_roughness_texture: Some(TextureUse::new(2.into())),
        normal_texture: Some(TextureUse {
            texture: 4.into(),
            amount: 0.5,
        }),
        occlusion_texture: Some(TextureUse {
            texture: 3.into(),
            amount: 0.25,
        }),
        emissive_texture: Some(TextureUse::new(1.into())),
        alpha_mode: AlphaMode::Mask { cutoff: 0.25 },
        ..material(1.0)
    });
    scene.meshes.raw[0].primitives[0].material = 1.into();
    scene
}

#[test]
fn textures_read_back_with_their_images() {
    for side in [16, 800] {
        let scene = scene(strip(7), side);
        for exporter in BOTH {
            let file = bytes(&scene, exporter);
            let (document, buffers) = read(&file);
            // Equal images are one.
            let sources = document.textures().map(|t| t.source().index());
            assert_eq!(sources.collect::<Vec<_>>(), [0, 0, 1, 2, 1]);
            for (image, stored) in document.images().zip([0, 2, 3]) {
                let stored = &scene.images.raw[stored];
                let gltf::image::Source::View { view, mime_type } = image.source() else {
                    panic!("images lie in the buffer");
                };
                let media_type = match stored.media_type {
                    MediaType::Png => "image/png",
                    MediaType::Jpeg => "image/jpeg",
                };
                assert_eq!((image.name(), mime_type), (Some(&*stored.name), media_type));
                let end = view.offset() + view.length();
                assert_eq!(buffers[0][view.offset()..end], *stored.bytes);
                assert_eq!((view.offset() % 4, view.target()), (0, None));
            }
            assert_eq!(document.samplers().count(), 3);
            let sampler = document.textures().nth(2).unwrap().sampler();
            assert_eq!(
                sampler.wrap_t(),
                gltf::texture::WrappingMode::MirroredRepeat
            );
            assert_eq!(
                sampler.mag_filter(),
                Some(gltf::texture::MagFilter::Nearest)
            );

            let material = document.materials().nth(1).unwrap();
            let pbr = material.pbr_metallic_roughness();
            assert_eq!(pbr.base_color_texture().unwrap().texture().index(), 0);
            let metal = pbr.metallic_roughness_texture().unwrap();
            assert_eq!((metal.texture().index(), metal.tex_coord()), (2, 0));
            let normal = material.normal_texture().unwrap();
            assert_eq!((normal.texture().index(), normal.scale()), (4, 0.5));
            let occlusion = material.occlusion_texture().unwrap();
            assert_eq!(
                (occlusion.texture().index(), occlusion.strength()),
                (3, 0.25)
            );
            assert_eq!(material.emissive_texture().unwrap().texture().index(), 1);
            assert_eq!(material.alpha_mode(), gltf::material::AlphaMode::Mask);
            assert_eq!(material.alpha_cutoff(), Some(0.25));
            assert_round_trip(&scene, exporter);
        }
    }
}

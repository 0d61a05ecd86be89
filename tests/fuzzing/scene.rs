//! As [`model`], for what a GLB says of its scene: mutations of whole files mostly change its vertices, and what changes the length of
//! its JSON ends before that is read.
//!
//! An input is the number of a model, of which the vertices are taken, and the JSON.

use std::sync::OnceLock;

use super::model;

/// The header of the file, and that of its JSON.
const JSON: usize = 20;

/// The models, each as its JSON and the rest of the file.
fn models() -> &'static [(Vec<u8>, Vec<u8>)] {
    static MODELS: OnceLock<Vec<(Vec<u8>, Vec<u8>)>> = OnceLock::new();
    MODELS.get_or_init(|| {
        let binary = model::seeds()
            .into_iter()
            .filter(|model| model.starts_with(b"glTF"));
        let parted = binary.map(|model| {
            let length = u32::from_le_bytes(model[12..16].try_into().expect("four bytes"));
            let (json, rest) = model[JSON..].split_at(length as usize);
            (json.to_vec(), rest.to_vec())
        });
        let models: Vec<_> = parted.take(usize::from(u8::MAX)).collect();
        assert!(models.len() > 20, "there are {} models", models.len());
        models
    })
}

pub(super) fn check(bytes: &[u8]) -> bool {
    let Some((number, json)) = bytes.split_first() else {
        return false;
    };
    let (_, rest) = &models()[usize::from(*number) % models().len()];
    let mut json = json.to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = (JSON + json.len() + rest.len()) as u32;
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend(length.to_le_bytes());
    file.extend((json.len() as u32).to_le_bytes());
    file.extend(b"JSON");
    file.extend(json);
    file.extend(rest);
    model::check(&file)
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let models = models().iter().enumerate();
    models
        .map(|(number, (json, _))| [&[number as u8], json.as_slice()].concat())
        .collect()
}

//! Materials as text. In: a material of a scene, or those of a glTF file. Out: texts that are equal exactly where the
//! materials are; which number a material or a texture has in its file does not matter.

use std::sync::Arc;

use serde_json::Value;

use crate::interpreter::material::Material;

/// Every field of a material.
pub fn material_text(material: &Material) -> Arc<str> {
    format!("{material:?}").into()
}

/// The materials of a file, with textures by the names of their images.
pub fn gltf_material_texts(document: &gltf::Document) -> Vec<Arc<str>> {
    let name = |texture: gltf::Texture| texture.source().name().unwrap_or_default().to_owned();
    let textures: Vec<String> = document.textures().map(name).collect();
    let text = |material: &gltf::json::Material| {
        let mut value = serde_json::to_value(material).expect("what was read from JSON is JSON");
        name_textures(&mut value, &textures);
        value.to_string().into()
    };
    document.as_json().materials.iter().map(text).collect()
}

/// Puts names in place of texture numbers: the `index` of every object called `…Texture`.
fn name_textures(value: &mut Value, names: &[String]) {
    match value {
        Value::Object(fields) => {
            for (key, inner) in fields {
                if key.ends_with("Texture")
                    && let Some(index) = inner.get_mut("index")
                    && let Some(name) = index.as_u64().and_then(|index| names.get(index as usize))
                {
                    *index = name.as_str().into();
                }
                name_textures(inner, names);
            }
        }
        Value::Array(items) => items.iter_mut().for_each(|item| name_textures(item, names)),
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn textures_go_by_name() {
        let mut value = serde_json::json!({ "a": { "baseColorTexture": { "index": 1, "texCoord": 0 } }, "index": 1 });
        name_textures(&mut value, &["x".to_owned(), "y".to_owned()]);
        let expected = serde_json::json!({ "a": { "baseColorTexture": { "index": "y", "texCoord": 0 } }, "index": 1 });
        assert_eq!(value, expected);
    }
}

//! glTF 2.0, as text (.gltf) or binary (.glb): triangles of all meshes, where the scene's nodes have them.

mod accessor;

use std::collections::BTreeSet;
use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use glam::{DMat4, DQuat, DVec3};
use serde::Deserialize;

use self::accessor::{Accessor, BufferView, Buffers};
use super::scene::{Assembly, Fault, MeshFile, MeshPart, Up, bounded, with_own_points};
use super::text::shown;

/// Levels of nodes in nodes; of more, or of nodes that hold themselves, there is no end.
const DEEPEST: usize = 200;
/// Objects and entries of lists of the JSON text; each takes up to some 300 and 30 bytes in memory.
const MOST_OBJECTS: usize = 500_000;
const MOST_ENTRIES: usize = 5_000_000;
/// Bytes of all buffers: many may be of one file beside it.
const MOST_BYTES: usize = 400_000_000;
/// Extensions that say nothing of the shape.
const OF_LOOKS: [&str; 4] = [
    "KHR_materials_",
    "KHR_texture_",
    "KHR_lights_",
    "EXT_texture_",
];

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", default)]
#[derive(Default)]
struct Root {
    scene: Option<usize>,
    scenes: Vec<SceneNodes>,
    nodes: Vec<Node>,
    meshes: Vec<Mesh>,
    materials: Vec<Material>,
    accessors: Vec<Accessor>,
    buffer_views: Vec<BufferView>,
    buffers: Vec<Buffer>,
    extensions_required: Vec<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct SceneNodes {
    nodes: Vec<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Node {
    children: Vec<usize>,
    mesh: Option<usize>,
    skin: Option<usize>,
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
}

#[derive(Debug, Deserialize)]
struct Mesh {
    primitives: Vec<Primitive>,
}

#[derive(Debug, Deserialize)]
struct Primitive {
    attributes: Attributes,
    indices: Option<usize>,
    material: Option<usize>,
    mode: Option<u32>,
}

#[derive(Debug, Deserialize)]
struct Attributes {
    #[serde(rename = "POSITION")]
    position: Option<usize>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct Material {
    pbr_metallic_roughness: Option<Roughness>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct Roughness {
    base_color_factor: Option<[f64; 4]>,
}

/// What a file of any version says of itself.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Head {
    asset: Asset,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Asset {
    version: serde_json::Value,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Buffer {
    uri: Option<String>,
}

pub(super) fn parse(bytes: &[u8], folder: &Path) -> Result<MeshFile, Fault> {
    let (json, chunk) = if bytes.starts_with(b"glTF") {
        chunks(bytes)?
    } else {
        (bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), None)
    };
    let count = |letter: u8| json.split(|byte| *byte == letter).count() - 1;
    if count(b'{') > MOST_OBJECTS || count(b',') > MOST_ENTRIES {
        return Err(Fault::unsupported(
            format!(
                "a JSON text of more than {MOST_OBJECTS} objects or {MOST_ENTRIES} entries of lists"
            ),
            "export a simpler scene",
        ));
    }
    // Files of version 1 have other forms: what they say of it is asked first.
    let head: Head = serde_json::from_slice(json)
        .map_err(|error| Fault::malformed(format!("its JSON: {error}")))?;
    if let Some(version) = head.asset.version.as_str()
        && version.starts_with("1.")
    {
        return Err(Fault::unsupported(
            format!("glTF version {version}"),
            "export it as glTF 2.0",
        ));
    }
    let root: Root = serde_json::from_slice(json)
        .map_err(|error| Fault::malformed(format!("its JSON: {error}")))?;
    for extension in &root.extensions_required {
        match extension.as_str() {
            "KHR_mesh_quantization" => {}
            looks if OF_LOOKS.iter().any(|known| looks.starts_with(known)) => {}
            "KHR_draco_mesh_compression" => {
                return Err(Fault::unsupported(
                    "Draco compression (KHR_draco_mesh_compression)",
                    "export the mesh without compression",
                ));
            }
            other => {
                return Err(Fault::unsupported(
                    format!("the glTF extension {other}, which the file requires"),
                    "export the mesh without it",
                ));
            }
        }
    }
    let data = all_buffers(&root, chunk, folder)?;
    let mut buffers = Buffers::new(&data, &root.buffer_views, &root.accessors);
    let mut assembly = Assembly::new(MeshFile {
        in_metres: true,
        up: Up::Y,
        ..MeshFile::unitless(Vec::new())
    });
    let (mut meshes, mut triangles, mut points) = (Vec::new(), 0, 0);
    for mesh in &root.meshes {
        let mut parts = Vec::new();
        for primitive in &mesh.primitives {
            assembly.pass(1)?;
            let part = part(primitive, &root, &mut buffers)?;
            triangles += part.triangles.len();
            points += part.points.len();
            bounded(triangles, points)?;
            parts.push(part);
        }
        meshes.push(parts);
    }
    let walk = Walk {
        root: &root,
        meshes,
    };
    for node in tops(&root)? {
        walk.node(node, DMat4::IDENTITY, 0, &mut assembly)?;
    }
    Ok(assembly.file)
}

/// The JSON and the binary chunk of a .glb.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Fault> {
    let word = |at: usize| {
        bytes
            .get(at..at + 4)
            .map(|four| u32::from_le_bytes([four[0], four[1], four[2], four[3]]))
    };
    if word(4) != Some(2) {
        return Err(Fault::unsupported(
            format!("glTF version {}", word(4).unwrap_or_default()),
            "export it as glTF 2.0",
        ));
    }
    let (mut json, mut binary, mut at) = (None, None, 12);
    while let (Some(length), Some(kind)) = (word(at), word(at + 4)) {
        let Some(chunk) = bytes.get(at + 8..at + 8 + length as usize) else {
            return Err(Fault::malformed(format!(
                "a chunk of {length} bytes goes beyond the file's end: it is cut short"
            )));
        };
        match kind {
            0x4e4f_534a if json.is_none() => json = Some(chunk),
            0x004e_4942 if binary.is_none() => binary = Some(chunk),
            _ => {}
        }
        at += 8 + length as usize;
    }
    let json = json.ok_or_else(|| Fault::malformed("it has no JSON chunk"))?;
    Ok((json, binary))
}

fn all_buffers(root: &Root, chunk: Option<&[u8]>, folder: &Path) -> Result<Vec<Vec<u8>>, Fault> {
    let (mut data, mut size) = (Vec::new(), 0);
    for (index, buffer) in root.buffers.iter().enumerate() {
        let own = load(buffer, index, chunk, folder)?;
        size += own.len();
        if size > MOST_BYTES {
            return Err(Fault::unsupported(
                format!("buffers of more than {} MB", MOST_BYTES / 1_000_000),
                "export a simpler scene",
            ));
        }
        data.push(own);
    }
    Ok(data)
}

/// A buffer's bytes: of the file's own chunk, of a data URI or of a file beside it.
fn load(
    buffer: &Buffer,
    index: usize,
    chunk: Option<&[u8]>,
    folder: &Path,
) -> Result<Vec<u8>, Fault> {
    let Some(uri) = &buffer.uri else {
        let own = chunk.filter(|_| index == 0);
        return own.map(<[u8]>::to_vec).ok_or_else(|| {
            Fault::malformed(format!(
                "buffer {index} has neither a uri nor a binary chunk"
            ))
        });
    };
    if let Some(data) = uri.strip_prefix("data:") {
        let Some((kind, coded)) = data
            .split_once(',')
            .filter(|(kind, _)| kind.ends_with(";base64"))
        else {
            return Err(Fault::malformed(format!(
                "buffer {index}: its data URI is not in base64"
            )));
        };
        return STANDARD
            .decode(coded)
            .map_err(|error| Fault::malformed(format!("buffer {index} ({kind}): {error}")));
    }
    let name = decoded(uri);
    if name.contains("://") {
        return Err(Fault::unsupported(
            format!("a buffer at {}", shown(&name)),
            "put it beside the file, or export a .glb",
        ));
    }
    crate::file::read(folder.join(&name))
        .map_err(|error| Fault::malformed(format!("buffer {index}, file {name}: {error}")))
}

/// A URI with its `%20` and others as the letters that they stand for.
fn decoded(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let (mut found, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        let coded = (bytes[at] == b'%')
            .then(|| bytes.get(at + 1..at + 3))
            .flatten();
        let letter =
            coded.and_then(|two| u8::from_str_radix(std::str::from_utf8(two).ok()?, 16).ok());
        found.push(letter.unwrap_or(bytes[at]));
        at += if letter.is_some() { 3 } else { 1 };
    }
    String::from_utf8_lossy(&found).into_owned()
}

/// Nodes at the top of the scene: of the one that is named, else of the first; without scenes those that are in no other.
fn tops(root: &Root) -> Result<Vec<usize>, Fault> {
    let which = root.scene.unwrap_or(0);
    match root.scenes.get(which) {
        Some(scene) => Ok(scene.nodes.clone()),
        None if root.scenes.is_empty() => {
            let inner: BTreeSet<usize> = (root.nodes.iter())
                .flat_map(|node| node.children.iter().copied())
                .collect();
            Ok((0..root.nodes.len())
                .filter(|node| !inner.contains(node))
                .collect())
        }
        None => Err(Fault::malformed(format!("there is no scene {which}"))),
    }
}

/// Triangles of a primitive; none of points and lines, which have no surface.
fn part(primitive: &Primitive, root: &Root, buffers: &mut Buffers) -> Result<MeshPart, Fault> {
    let mode = primitive.mode.unwrap_or(4);
    let position = primitive.attributes.position;
    let Some(position) = position.filter(|_| (4..=6).contains(&mode)) else {
        return Ok(MeshPart::default());
    };
    let points = buffers.points(position)?;
    let indices = match primitive.indices {
        Some(indices) => buffers.indices(indices)?,
        None => (0..points.len() as u32).collect(),
    };
    if let Some(index) = indices
        .iter()
        .find(|index| **index as usize >= points.len())
    {
        return Err(Fault::malformed(format!(
            "a triangle refers to the missing vertex {index} (there are {})",
            points.len()
        )));
    }
    let triangles: Vec<[u32; 3]> = match mode {
        4 => indices
            .chunks_exact(3)
            .map(|three| [three[0], three[1], three[2]])
            .collect(),
        5 => super::polygon::strip(&indices),
        _ => super::polygon::fan(&indices),
    };
    let material = primitive
        .material
        .and_then(|index| root.materials.get(index));
    let roughness = material.and_then(|material| material.pbr_metallic_roughness.as_ref());
    Ok(MeshPart {
        colour: roughness.and_then(|roughness| roughness.base_color_factor),
        ..with_own_points(&points, &triangles)
    })
}

struct Walk<'a> {
    root: &'a Root,
    meshes: Vec<Vec<MeshPart>>,
}

impl Walk<'_> {
    fn node(
        &self,
        index: usize,
        parent: DMat4,
        depth: usize,
        assembly: &mut Assembly,
    ) -> Result<(), Fault> {
        assembly.pass(1)?;
        if depth > DEEPEST {
            return Err(Fault::malformed(format!(
                "node {index} lies more than {DEEPEST} nodes deep, or in itself"
            )));
        }
        let node = self
            .root
            .nodes
            .get(index)
            .ok_or_else(|| Fault::malformed(format!("there is no node {index}")))?;
        let place = parent * transform(node);
        if let Some(mesh) = node.mesh {
            if node.skin.is_some() {
                return Err(Fault::unsupported(
                    format!("a skin (node {index})"),
                    "export the mesh as it stands, without bones",
                ));
            }
            let parts = self
                .meshes
                .get(mesh)
                .ok_or_else(|| Fault::malformed(format!("there is no mesh {mesh}")))?;
            for part in parts {
                assembly.place(part, place)?;
            }
        }
        for child in &node.children {
            self.node(*child, place, depth + 1, assembly)?;
        }
        Ok(())
    }
}

fn transform(node: &Node) -> DMat4 {
    if let Some(matrix) = &node.matrix {
        return DMat4::from_cols_array(matrix);
    }
    let rotation = node.rotation.map_or(DQuat::IDENTITY, DQuat::from_array);
    DMat4::from_scale_rotation_translation(
        node.scale.map_or(DVec3::ONE, DVec3::from_array),
        rotation.normalize(),
        node.translation.map_or(DVec3::ZERO, DVec3::from_array),
    )
}

//! Numbers of a glTF file: an accessor's view of a buffer.

use glam::DVec3;
use serde::Deserialize;

use crate::mesh_file::scene::Fault;

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    buffer_view: Option<usize>,
    #[serde(default)]
    byte_offset: usize,
    component_type: u32,
    #[serde(default)]
    normalized: bool,
    count: usize,
    #[serde(rename = "type")]
    kind: String,
    sparse: Option<serde_json::Value>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    buffer: usize,
    #[serde(default)]
    byte_offset: usize,
    byte_length: usize,
    byte_stride: Option<usize>,
}

/// Buffers with what says how they are read.
pub(super) struct Buffers<'a> {
    pub(super) data: &'a [Vec<u8>],
    pub(super) views: &'a [BufferView],
    pub(super) accessors: &'a [Accessor],
}

impl Buffers<'_> {
    /// Positions.
    pub(super) fn points(&self, accessor: usize) -> Result<Vec<DVec3>, Fault> {
        let numbers = self.numbers(accessor, "VEC3", 3)?;
        Ok(numbers.chunks_exact(3).map(DVec3::from_slice).collect())
    }

    /// Indices of vertices.
    pub(super) fn indices(&self, accessor: usize) -> Result<Vec<u32>, Fault> {
        let numbers = self.numbers(accessor, "SCALAR", 1)?;
        Ok(numbers.iter().map(|number| *number as u32).collect())
    }

    /// `width` numbers of each of an accessor's entries.
    fn numbers(&self, index: usize, kind: &str, width: usize) -> Result<Vec<f64>, Fault> {
        let fault = |reason: String| Fault::malformed(format!("accessor {index}: {reason}"));
        let accessor = self
            .accessors
            .get(index)
            .ok_or_else(|| fault("there is none".to_owned()))?;
        if accessor.kind != kind {
            return Err(fault(format!(
                "its type is {}, expected {kind}",
                accessor.kind
            )));
        }
        if accessor.sparse.is_some() {
            return Err(Fault::unsupported(
                format!("a sparse accessor ({index})"),
                "export the mesh without sparse accessors",
            ));
        }
        let size = match accessor.component_type {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            5125 | 5126 => 4,
            other => {
                return Err(fault(format!(
                    "its component type is {other}, expected 5120 to 5123, 5125 or 5126"
                )));
            }
        };
        let view = accessor.buffer_view.and_then(|view| self.views.get(view));
        let view = view.ok_or_else(|| fault("it has no buffer view".to_owned()))?;
        let buffer = self
            .data
            .get(view.buffer)
            .ok_or_else(|| fault(format!("there is no buffer {}", view.buffer)))?;
        let end = view.byte_offset.checked_add(view.byte_length);
        let bytes = end.and_then(|end| buffer.get(view.byte_offset..end));
        let bytes =
            bytes.ok_or_else(|| fault("its view goes beyond its buffer's end".to_owned()))?;
        let stride = view
            .byte_stride
            .filter(|stride| *stride > 0)
            .unwrap_or(size * width);
        let mut found = Vec::new();
        for entry in 0..accessor.count {
            for component in 0..width {
                let at = entry
                    .checked_mul(stride)
                    .and_then(|at| at.checked_add(accessor.byte_offset + component * size));
                let value = at.and_then(|at| bytes.get(at..at.checked_add(size)?));
                let value =
                    value.ok_or_else(|| fault("it goes beyond its view's end".to_owned()))?;
                found.push(number(value, accessor.component_type, accessor.normalized));
            }
        }
        Ok(found)
    }
}

fn number(bytes: &[u8], component: u32, normalized: bool) -> f64 {
    let at = |index: usize| bytes.get(index).copied().unwrap_or(0);
    let four = [at(0), at(1), at(2), at(3)];
    let (value, most) = match component {
        5120 => (f64::from(i8::from_le_bytes([at(0)])), f64::from(i8::MAX)),
        5121 => (f64::from(at(0)), f64::from(u8::MAX)),
        5122 => (
            f64::from(i16::from_le_bytes([at(0), at(1)])),
            f64::from(i16::MAX),
        ),
        5123 => (
            f64::from(u16::from_le_bytes([at(0), at(1)])),
            f64::from(u16::MAX),
        ),
        5125 => (f64::from(u32::from_le_bytes(four)), f64::from(u32::MAX)),
        _ => return f64::from(f32::from_le_bytes(four)),
    };
    if normalized {
        (value / most).max(-1.0)
    } else {
        value
    }
}

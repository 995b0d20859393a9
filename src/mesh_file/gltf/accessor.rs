//! Numbers of a glTF file: an accessor's view of a buffer.

use std::collections::BTreeMap;
use std::rc::Rc;

use glam::DVec3;
use serde::Deserialize;
use serde::de::IgnoredAny;

use crate::mesh_file::scene::{Fault, bounded};
use crate::mesh_file::text::shown;

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
    sparse: Option<IgnoredAny>,
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
    data: &'a [Vec<u8>],
    views: &'a [BufferView],
    accessors: &'a [Accessor],
    /// Positions that were read already: primitives may share them.
    known: BTreeMap<usize, Rc<Vec<DVec3>>>,
    /// Points and indices read so far: views may lie over each other.
    points: usize,
    indices: usize,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(
        data: &'a [Vec<u8>],
        views: &'a [BufferView],
        accessors: &'a [Accessor],
    ) -> Self {
        Self {
            data,
            views,
            accessors,
            known: BTreeMap::new(),
            points: 0,
            indices: 0,
        }
    }

    /// Positions.
    pub(super) fn points(&mut self, accessor: usize) -> Result<Rc<Vec<DVec3>>, Fault> {
        if let Some(known) = self.known.get(&accessor) {
            return Ok(Rc::clone(known));
        }
        let count = self.accessors.get(accessor).map_or(0, |own| own.count);
        self.points = self.points.saturating_add(count);
        bounded(0, self.points)?;
        let mut points = Vec::new();
        self.entries(accessor, "VEC3", |at| {
            points.push(DVec3::new(at(0), at(1), at(2)));
        })?;
        let points = Rc::new(points);
        self.known.insert(accessor, Rc::clone(&points));
        Ok(points)
    }

    /// Indices of vertices.
    pub(super) fn indices(&mut self, accessor: usize) -> Result<Vec<u32>, Fault> {
        let count = self.accessors.get(accessor).map_or(0, |own| own.count);
        self.indices = self.indices.saturating_add(count);
        bounded(self.indices / 3, 0)?;
        let mut indices = Vec::new();
        self.entries(accessor, "SCALAR", |at| indices.push(at(0) as u32))?;
        Ok(indices)
    }

    /// Hands on each of an accessor's entries, as its numbers by their places.
    fn entries(
        &self,
        index: usize,
        kind: &str,
        mut take: impl FnMut(&dyn Fn(usize) -> f64),
    ) -> Result<(), Fault> {
        let width = if kind == "VEC3" { 3 } else { 1 };
        let fault = |reason: String| Fault::malformed(format!("accessor {index}: {reason}"));
        let accessor = self
            .accessors
            .get(index)
            .ok_or_else(|| fault("there is none".to_owned()))?;
        if accessor.kind != kind {
            return Err(fault(format!(
                "its type is {}, expected {kind}",
                shown(&accessor.kind)
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
        for entry in 0..accessor.count {
            let at = entry
                .checked_mul(stride)
                .and_then(|at| at.checked_add(accessor.byte_offset));
            let own = at.and_then(|at| bytes.get(at..at.checked_add(width * size)?));
            let own = own.ok_or_else(|| fault("it goes beyond its view's end".to_owned()))?;
            take(&|place| {
                let value = &own[place * size..(place + 1) * size];
                number(value, accessor.component_type, accessor.normalized)
            });
        }
        Ok(())
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

//! A number that follows from the content of a recording.

use super::options::RerunOptions;
use crate::recording::Recording;
use crate::scene::Scene;

/// Lanes of the hash, side by side, as one alone would wait for each product.
const LANES: usize = 4;
const SEEDS: [u64; LANES] = [
    0xcbf2_9ce4_8422_2325,
    0x9e37_79b9_7f4a_7c15,
    0xc2b2_ae3d_27d4_eb4f,
    0x1656_67b1_9e37_79f9,
];
const PRIME: u64 = 0x0000_0100_0000_01b3;

/// A number that follows from content (FNV-1a, word by word): two recordings open in one viewer are distinct, the same recording written twice is
/// the same.
pub(super) struct Fingerprint {
    lanes: [u64; LANES],
}

impl Default for Fingerprint {
    fn default() -> Self {
        Self { lanes: SEEDS }
    }
}

impl Fingerprint {
    /// Takes in a text.
    pub(super) fn text(&mut self, text: &str) {
        for (index, byte) in text.bytes().enumerate() {
            add(&mut self.lanes[index % LANES], u64::from(byte));
        }
    }

    /// Takes in values.
    pub(super) fn values(&mut self, values: &[f64]) {
        let groups = values.chunks_exact(LANES);
        let rest = groups.remainder();
        for group in groups.chain([rest]) {
            for (lane, value) in self.lanes.iter_mut().zip(group) {
                add(lane, value.to_bits());
            }
        }
    }

    /// The number.
    pub(super) fn finish(self) -> u64 {
        let mut hash = SEEDS[0];
        for lane in self.lanes {
            add(&mut hash, lane);
        }
        hash
    }
}

/// The number of a recording with its scene, and of what it was made of.
pub(super) fn fingerprint(
    origin: &str,
    recording: &Recording,
    scene: &Scene,
    options: &RerunOptions,
) -> u64 {
    let mut hash = Fingerprint::default();
    hash.text(origin);
    hash.text(&scene.title);
    hash.text(&options.summary_markdown);
    for channel in recording.channels() {
        hash.values(&channel.values);
    }
    hash.values(recording.time());
    hash.finish()
}

/// Takes in a word. Its high half is folded down: a product carries only upwards, and values differ mostly in their high bits.
fn add(hash: &mut u64, word: u64) {
    *hash = (*hash ^ word).wrapping_mul(PRIME);
    *hash ^= *hash >> 32;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{RecordedChannel, Unit};

    #[test]
    fn every_bit_of_every_value_counts() {
        let hash = |values: [f64; 6]| {
            let force = RecordedChannel::new("contact_force", Unit::Newton, values.to_vec());
            let time = (0..6).map(f64::from).collect();
            let recording = Recording::new(time, vec![force], vec![]).unwrap();
            fingerprint("", &recording, &Scene::default(), &RerunOptions::default())
        };
        let values = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let mut seen = vec![hash(values)];
        for index in 0..values.len() {
            for bit in 0..63 {
                let mut other = values;
                other[index] = f64::from_bits(other[index].to_bits() ^ (1 << bit));
                seen.push(hash(other));
            }
        }
        let count = seen.len();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), count);
    }
}

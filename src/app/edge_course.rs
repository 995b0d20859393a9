//! The edge while it is worked, as a recording's samples tell it: what came off in each step, where the tool was.

use crate::cell::Cell;
use crate::recording::{Recording, RecordingError, schema};
use crate::removal::EdgeStationState;
use crate::scene::finished_edge::EdgeMoment;

/// Moments that are drawn, and stations of each at most.
const MOMENTS: usize = 80;
const STATIONS: usize = 280;

/// The edge before any work and at moments while it is worked, the last of them after all of it; none where nothing comes off.
///
/// # Errors
/// The recording lacks a channel.
pub fn edge_course(cell: &Cell, recording: &Recording) -> Result<Vec<EdgeMoment>, RecordingError> {
    let Some(removal) = &cell.setup.scenario.removal else {
        return Ok(Vec::new());
    };
    let time = recording.time();
    let rate = recording.values(schema::REMOVAL_RATE)?;
    let planned = recording.values(schema::PATH_LENGTH)?;
    let lag = recording.values(schema::PATH_LAG)?;
    // A step cuts where the sample before it has left the tool.
    let place = |sample: usize| planned[sample - 1] - lag[sample - 1];
    let half = 0.5 * removal.contact_length;
    let cutting: Vec<usize> = (1..time.len())
        .filter(|i| rate[*i] > 0.0 && place(*i).is_finite())
        .collect();
    let Some(last) = cutting.last() else {
        return Ok(Vec::new());
    };
    let mut edge = cell.setup.part.edge_state.clone();
    let every = edge.stations().len().div_ceil(STATIONS).max(1);
    let stations: Vec<usize> = (0..edge.stations().len()).step_by(every).collect();
    let moment = |sample: usize, states: &[EdgeStationState]| {
        let of = |value: fn(&EdgeStationState) -> f64| {
            stations.iter().map(|i| value(&states[*i])).collect()
        };
        EdgeMoment {
            sample,
            stations: stations.clone(),
            burr: of(EdgeStationState::burr),
            leg: of(EdgeStationState::leg),
        }
    };
    let mut moments = vec![moment(0, edge.stations())];
    let each = cutting.len().div_ceil(MOMENTS).max(1);
    for (count, sample) in cutting.iter().enumerate() {
        let taken = rate[*sample] * (time[*sample] - time[*sample - 1]);
        edge.remove(place(*sample) - half, place(*sample) + half, taken);
        if *sample == *last || (count + 1) % each == 0 {
            moments.push(moment(*sample, edge.stations()));
        }
    }
    Ok(moments)
}

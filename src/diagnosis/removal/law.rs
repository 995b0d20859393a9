//! A row of the table, and the law that predicts it.

use crate::listed::listed;

/// A run: its settings and what it took off. NaN where it is not known, or the table has no such column.
#[derive(Debug, Clone, PartialEq)]
pub struct TableRow {
    /// File of the table.
    pub table: String,
    /// Its line, from 1.
    pub line: u64,
    /// Normal force [N].
    pub force: f64,
    /// Grinding time [s]; of a moving tool the time per length, 1/feed [s/m].
    pub time: f64,
    /// Cutting speed, in any one unit.
    pub speed: f64,
    /// Contact area [m2].
    pub area: f64,
    /// Wear of the tool before the run, in any one unit.
    pub wear: f64,
    /// Volume taken off [m3].
    pub volume: f64,
    /// Its weight in the fit: 1 of a measurement [1].
    pub weight: f64,
    /// Standard deviation of the logarithm of its volume that is known of how it is measured [1]; 0 where nothing is. What is left may be less by chance, or as
    /// rows are no measurements of their own, but is not taken for less.
    pub scatter: f64,
}

/// Settings at which the law has its reference volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// Force [N].
    pub force: f64,
    /// Time [s] or [s/m].
    pub time: f64,
    /// Speed.
    pub speed: f64,
    /// Area [m2].
    pub area: f64,
}

listed! {
    /// A number of the law in which it may deviate from its nominal value.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum Deviation: 8,
    /// Name in diagnosis.json.
    name: &'static str {
        /// Volume at the reference settings, where the nominal law states it.
        Coefficient = "removal_coefficient",
        /// Exponent of the force.
        Force = "removal_force_exponent",
        /// Force below which nothing comes off.
        Threshold = "removal_threshold_force",
        /// Speed lost per force.
        Sag = "tool_speed_sag",
        /// Loss per wear.
        Wear = "tool_wear",
        /// Exponent of the speed.
        Speed = "removal_speed_exponent",
        /// Exponent of the time.
        Time = "removal_time_exponent",
        /// Exponent of the area.
        Area = "removal_area_exponent",
    }
}

impl Deviation {
    /// Name of its number, in the improved file too.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Coefficient => "reference_volume_mm3",
            Self::Force => "force_exponent",
            Self::Threshold => "threshold_force_n",
            Self::Sag => "speed_sag_per_n",
            Self::Wear => "wear_rate",
            Self::Speed => "speed_exponent",
            Self::Time => "time_exponent",
            Self::Area => "area_exponent",
        }
    }
}

/// The law; an exponent of what the table has no column of does nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TableLaw {
    /// Volume at the reference settings, of a new tool [m3]; none: to be fitted.
    pub volume: Option<f64>,
    /// Those settings.
    pub reference: Reference,
    /// Exponent of the force [1].
    pub force: f64,
    /// Exponent of the time [1]; of the feed it is the negative.
    pub time: f64,
    /// Exponent of the speed [1].
    pub speed: f64,
    /// Exponent of the area [1].
    pub area: f64,
    /// Force below which nothing comes off [N].
    pub threshold: f64,
    /// Share of the speed lost per force [1/N].
    pub sag: f64,
    /// Natural logarithm lost per wear, in one over the wear's unit.
    pub wear: f64,
}

impl TableLaw {
    /// Logarithm of the volume over the reference volume; negative infinity where nothing comes off.
    #[must_use]
    pub fn log_ratio(&self, row: &TableRow) -> f64 {
        let [force, speed, time, area, wear] = self.terms(row);
        let of = |exponent: f64, term: f64| {
            if exponent == 0.0 {
                0.0
            } else {
                exponent * term
            }
        };
        of(self.force, force) + of(self.speed, speed) + of(self.time, time) + of(self.area, area)
            - of(self.wear, wear)
    }

    /// Logarithms that the exponents of force, speed, time and area multiply, and the wear.
    #[must_use]
    pub fn terms(&self, row: &TableRow) -> [f64; 5] {
        let at = &self.reference;
        // What has no column is as at the reference.
        let log = |value: f64, reference: f64| {
            if reference.is_nan() {
                0.0
            } else {
                (value / reference).ln()
            }
        };
        let pressing = ((row.force - self.threshold) / (at.force - self.threshold)).max(0.0);
        let turning = ((1.0 - self.sag * row.force) / (1.0 - self.sag * at.force)).max(0.0);
        [
            pressing.ln(),
            log(row.speed, at.speed) + turning.ln(),
            log(row.time, at.time),
            log(row.area, at.area),
            row.wear,
        ]
    }

    /// Volume that it predicts [m3]; 0 below the threshold.
    #[must_use]
    pub fn volume_of(&self, row: &TableRow) -> f64 {
        self.volume.unwrap_or(f64::NAN) * self.log_ratio(row).exp()
    }

    /// One of its numbers.
    #[must_use]
    pub fn number(&self, of: Deviation) -> f64 {
        match of {
            Deviation::Coefficient => self.volume.unwrap_or(f64::NAN),
            Deviation::Force => self.force,
            Deviation::Threshold => self.threshold,
            Deviation::Sag => self.sag,
            Deviation::Wear => self.wear,
            Deviation::Speed => self.speed,
            Deviation::Time => self.time,
            Deviation::Area => self.area,
        }
    }

    /// The same with one of its numbers another.
    #[must_use]
    pub fn with(mut self, of: Deviation, value: f64) -> Self {
        match of {
            Deviation::Coefficient => self.volume = Some(value),
            Deviation::Force => self.force = value,
            Deviation::Threshold => self.threshold = value,
            Deviation::Sag => self.sag = value,
            Deviation::Wear => self.wear = value,
            Deviation::Speed => self.speed = value,
            Deviation::Time => self.time = value,
            Deviation::Area => self.area = value,
        }
        self
    }
}

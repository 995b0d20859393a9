//! Relation between the coordinates of a fit and a number of the rig's description.

/// Relation between the fit's coordinate u and a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Coordinate {
    /// value = scale u, scale in the quantity's unit.
    Linear(f64),
    /// value = exp(u): what is positive and of unknown size.
    Logarithmic,
}

impl Coordinate {
    /// Value at a coordinate.
    pub fn value(self, coordinate: f64) -> f64 {
        match self {
            Self::Linear(scale) => scale * coordinate,
            Self::Logarithmic => coordinate.exp(),
        }
    }

    /// Coordinate of a value.
    pub fn of(self, value: f64) -> f64 {
        match self {
            Self::Linear(scale) => value / scale,
            Self::Logarithmic => value.ln(),
        }
    }

    /// d value / d coordinate at a value.
    pub fn slope(self, value: f64) -> f64 {
        match self {
            Self::Linear(scale) => scale,
            Self::Logarithmic => value,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_comes_back_from_its_coordinate_and_moves_with_it_by_the_slope() {
        for coordinate in [Coordinate::Linear(0.25), Coordinate::Logarithmic] {
            for value in [0.3, 2.0, 70.0] {
                let at = coordinate.of(value);
                assert!((coordinate.value(at) / value - 1.0).abs() < 1e-12);
                let [low, high] = [-1e-5, 1e-5].map(|step| coordinate.value(at + step));
                let slope = (high - low) / 2e-5;
                assert!((coordinate.slope(value) / slope - 1.0).abs() < 1e-8);
            }
        }
    }
}

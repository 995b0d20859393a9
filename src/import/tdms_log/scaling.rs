//! Properties of an object, and the scales that make quantities of a converter's numbers, as the properties of a channel say (`NI_Scale[0]_Linear_Slope`): linear ones and polynomials.

use std::collections::BTreeMap;

/// A property of an object.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::import) enum Property {
    Number(f64),
    Text(String),
    /// Since 1970 [ns]; none where it is zero.
    Stamp(Option<i64>),
}

/// Input of a scale that takes the numbers as they are stored.
const RAW: u32 = u32::MAX;

/// Scales of a channel, each with its input.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scales(Vec<Scale>);

#[derive(Debug, Clone, PartialEq)]
struct Scale {
    input: u32,
    /// Coefficients, the constant first.
    coefficients: Vec<f64>,
}

impl Scales {
    /// The scales that properties name; none where there are none, or they have been applied.
    ///
    /// # Errors
    /// The kind of one that is not known.
    pub fn of(properties: &BTreeMap<String, Property>) -> Result<Option<Self>, String> {
        /// Scales of a channel, at most.
        const MOST: usize = 64;
        let number = |key: &str| match properties.get(key) {
            Some(Property::Number(number)) => Some(*number),
            _ => None,
        };
        let is_scaled = properties.get("NI_Scaling_Status");
        let count = number("NI_Number_Of_Scales").unwrap_or(0.0) as usize;
        if count == 0 || is_scaled == Some(&Property::Text("scaled".to_owned())) {
            return Ok(None);
        }
        if count > MOST {
            return Err(format!(
                "scaled by {count} scales, of which {MOST} are read"
            ));
        }
        let mut scales = Vec::with_capacity(count);
        for index in 0..count {
            let key = |rest: &str| format!("NI_Scale[{index}]_{rest}");
            let of = |rest: &str| number(&key(rest));
            let Some(Property::Text(kind)) = properties.get(&key("Scale_Type")) else {
                return Err(format!(
                    "scaled by a scale without a kind (`{}`)",
                    key("Scale_Type")
                ));
            };
            let coefficients = match kind.as_str() {
                "Linear" => vec![of("Linear_Y_Intercept"), of("Linear_Slope")],
                "Polynomial" => {
                    let size = of("Polynomial_Coefficients_Size").map_or(4, |size| size as usize);
                    (0..size.min(MOST))
                        .map(|i| of(&format!("Polynomial_Coefficients[{i}]")))
                        .collect()
                }
                "AdvancedAPI" => vec![Some(0.0), Some(1.0)],
                other => return Err(format!("scaled by a scale of the kind `{other}`")),
            };
            let coefficients: Option<Vec<f64>> = coefficients.into_iter().collect();
            scales.push(Scale {
                input: of(&format!("{kind}_Input_Source")).map_or(RAW, |input| input as u32),
                coefficients: coefficients.ok_or_else(|| {
                    format!(
                        "scaled by a scale without all of its numbers (`{}`)",
                        key(kind)
                    )
                })?,
            });
        }
        let goes_back =
            |(index, scale): (usize, &Scale)| scale.input == RAW || (scale.input as usize) < index;
        if !scales.iter().enumerate().all(goes_back) {
            return Err("scaled by scales that need one another".to_owned());
        }
        Ok(Some(Self(scales)))
    }

    /// A number scaled.
    pub fn apply(&self, raw: f64) -> f64 {
        let mut values: Vec<f64> = Vec::with_capacity(self.0.len());
        for scale in &self.0 {
            let input = values.get(scale.input as usize).copied().unwrap_or(raw);
            let terms = scale.coefficients.iter().rev();
            values.push(terms.fold(0.0, |sum, coefficient| sum * input + coefficient));
        }
        values.last().copied().unwrap_or(raw)
    }
}

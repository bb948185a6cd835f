//! Named arrays, and how what owns numbers records them there or takes them back.

use std::collections::BTreeMap;

use carom_fem::material::PlasticState;
use carom_mesh::Vector;
use thiserror::Error;

/// A run at one moment, as named arrays.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Checkpoint {
    /// Arrays of numbers, in the units of what they hold.
    pub numbers: BTreeMap<String, Vec<f64>>,
    /// Arrays of counts, indices and flags.
    pub integers: BTreeMap<String, Vec<u64>>,
}

impl Checkpoint {
    /// Version of what is kept and of its names.
    pub const SCHEMA: u64 = 22;
}

/// Why a run cannot be a checkpoint, or a checkpoint not the run.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{array}: {what}")]
pub struct CheckpointError {
    /// Name of the array.
    pub array: String,
    /// What is wrong with it.
    pub what: String,
}

impl CheckpointError {
    /// An error of an array.
    pub fn new(array: &str, what: impl Into<String>) -> Self {
        Self { array: array.to_string(), what: what.into() }
    }
}

/// A checkpoint that is written or read, by the same list of arrays.
pub enum Archive<'a> {
    /// Values go into the checkpoint.
    Record(&'a mut Checkpoint),
    /// Values are overwritten by those of the checkpoint.
    Replay(&'a Checkpoint),
}

type Done = Result<(), CheckpointError>;

impl Archive<'_> {
    /// Whether values are overwritten.
    pub fn replays(&self) -> bool {
        matches!(self, Self::Replay(_))
    }

    /// Finite numbers.
    pub fn numbers<'n>(&mut self, name: &str, values: impl IntoIterator<Item = &'n mut f64>) -> Done {
        self.transfer(name, values, f64::is_finite)
    }

    /// Numbers that may be infinite, as the smallest of none is.
    pub fn extremes<'n>(&mut self, name: &str, values: impl IntoIterator<Item = &'n mut f64>) -> Done {
        self.transfer(name, values, |x| !x.is_nan())
    }

    /// Numbers of which some may be missing: these are NaN.
    pub fn optional<'n>(
        &mut self,
        name: &str,
        values: impl IntoIterator<Item = &'n mut Option<f64>>,
    ) -> Done {
        let mut values: Vec<&mut Option<f64>> = values.into_iter().collect();
        let mut numbers: Vec<f64> = values.iter().map(|v| v.unwrap_or(f64::NAN)).collect();
        self.transfer(name, &mut numbers, |x| !x.is_infinite())?;
        values.iter_mut().zip(numbers).for_each(|(v, x)| **v = (!x.is_nan()).then_some(x));
        Ok(())
    }

    /// The components of finite vectors, one after the other.
    pub fn vectors<const D: usize>(&mut self, name: &str, vectors: &mut [Vector<D>]) -> Done {
        self.numbers(name, vectors.iter_mut().flat_map(|v| v.iter_mut()))
    }

    /// What the material remembers, point by point.
    pub fn plastic<'n>(
        &mut self,
        name: &str,
        points: impl IntoIterator<Item = &'n mut PlasticState>,
    ) -> Done {
        let terms = |p: &'n mut PlasticState| p.inverse_strain.iter_mut().chain([&mut p.equivalent_strain]);
        self.numbers(name, points.into_iter().flat_map(terms))
    }

    /// Rows of numbers that wait to be written elsewhere; NaN where there is nothing to write.
    pub fn pending(&mut self, name: &str, values: &mut Vec<f64>) -> Done {
        values.resize(self.rows(name, values.len())?, 0.0);
        self.transfer(name, values, |x| !x.is_infinite())
    }

    /// Counts and indices.
    pub fn integers<'n, T>(&mut self, name: &str, values: impl IntoIterator<Item = &'n mut T>) -> Done
    where
        T: Copy + TryInto<u64> + TryFrom<u64> + 'n,
    {
        let too_large = || CheckpointError::new(name, "is too large a number");
        match self {
            Self::Record(checkpoint) => {
                let values = values.into_iter().map(|v| (*v).try_into().map_err(|_| too_large()));
                checkpoint.integers.insert(name.to_string(), values.collect::<Result<_, _>>()?);
                Ok(())
            }
            Self::Replay(checkpoint) => {
                let stored = checkpoint.integers.get(name).ok_or_else(|| missing(name))?;
                replay(name, stored, values, |v, x| {
                    *v = T::try_from(x).map_err(|_| too_large())?;
                    Ok(())
                })
            }
        }
    }

    /// Yes or no.
    pub fn flags<'n>(&mut self, name: &str, values: impl IntoIterator<Item = &'n mut bool>) -> Done {
        let mut values: Vec<&mut bool> = values.into_iter().collect();
        let mut integers: Vec<u64> = values.iter().map(|v| u64::from(**v)).collect();
        self.integers(name, &mut integers)?;
        values.iter_mut().zip(integers).for_each(|(v, x)| **v = x != 0);
        Ok(())
    }

    /// How many entries there will be of what grows with time: as many as are `present`, or as the checkpoint has.
    pub fn rows(&self, name: &str, present: usize) -> Result<usize, CheckpointError> {
        let Self::Replay(checkpoint) = self else { return Ok(present) };
        let numbers = checkpoint.numbers.get(name).map(Vec::len);
        let length = numbers.or_else(|| checkpoint.integers.get(name).map(Vec::len));
        length.ok_or_else(|| missing(name))
    }

    fn transfer<'n>(
        &mut self,
        name: &str,
        values: impl IntoIterator<Item = &'n mut f64>,
        is_valid: impl Fn(f64) -> bool,
    ) -> Done {
        let check = |x: f64| {
            if is_valid(x) { Ok(x) } else { Err(CheckpointError::new(name, format!("holds {x}"))) }
        };
        match self {
            Self::Record(checkpoint) => {
                let values = values.into_iter().map(|v| check(*v)).collect::<Result<_, _>>()?;
                checkpoint.numbers.insert(name.to_string(), values);
                Ok(())
            }
            Self::Replay(checkpoint) => {
                let stored = checkpoint.numbers.get(name).ok_or_else(|| missing(name))?;
                replay(name, stored, values, |v, x| {
                    *v = check(x)?;
                    Ok(())
                })
            }
        }
    }
}

fn missing(name: &str) -> CheckpointError {
    CheckpointError::new(name, "is missing")
}

/// Overwrites every value by the stored one; there must be as many.
fn replay<'n, T: 'n, S: Copy>(
    name: &str,
    stored: &[S],
    values: impl IntoIterator<Item = &'n mut T>,
    mut overwrite: impl FnMut(&'n mut T, S) -> Done,
) -> Done {
    let mut count = 0;
    for value in values {
        if let Some(&x) = stored.get(count) {
            overwrite(value, x)?;
        }
        count += 1;
    }
    if count == stored.len() {
        return Ok(());
    }
    Err(CheckpointError::new(name, format!("has {} entries, not {count}", stored.len())))
}
